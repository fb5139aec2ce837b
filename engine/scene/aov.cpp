#include "engine/scene/aov.h"

#include <algorithm>

#include "shaders/shared/limits.h"

namespace edgesplat {
namespace {

constexpr std::array kAovs{
    Aov{"tau",
        "optical depth along each pixel's ray; buried voxels are included",
        &AovRequest::tau,
        shader::PAYLOAD_TAU,
        3,
        {"tau"}},
    Aov{"depth",
        "mean distance along the view axis",
        &AovRequest::depth,
        shader::PAYLOAD_DEPTH_DISTANCE,
        0,
        {"depth.Z"}},
    Aov{"normal",
        "mean world normal of the visible matter",
        &AovRequest::normal,
        shader::PAYLOAD_NORMAL,
        0,
        {"normal.X", "normal.Y", "normal.Z"}},
    Aov{"distance",
        "mean signed distance of the visible voxels to their edge",
        &AovRequest::distance,
        shader::PAYLOAD_DEPTH_DISTANCE,
        1,
        {"distance"}},
};

}  // namespace

std::span<const Aov, kAovCount> aovs() {
    return kAovs;
}

std::vector<std::string> aov_names() {
    std::vector<std::string> names;
    for (const Aov& aov : kAovs)
        names.emplace_back(aov.name);
    return names;
}

AovRequest aov_request(std::span<const std::string> names) {
    AovRequest request;
    for (const Aov& aov : kAovs)
        request.*aov.wanted = std::ranges::find(names, aov.name) != names.end();
    return request;
}

std::vector<std::uint32_t> payloads_of(const AovRequest& outputs) {
    std::vector<std::uint32_t> payloads{shader::PAYLOAD_COLOR};
    for (const Aov& aov : kAovs)
        if (outputs.*aov.wanted && std::ranges::find(payloads, aov.payload) == payloads.end())
            payloads.push_back(aov.payload);
    std::ranges::sort(payloads);
    return payloads;
}

std::string payload_name(std::uint32_t payload) {
    std::string text;
    for (const Aov& aov : kAovs)
        if (aov.payload == payload) text += (text.empty() ? "" : ", ") + std::string(aov.name);
    return text.empty() ? "colour" : text;
}

}  // namespace edgesplat
