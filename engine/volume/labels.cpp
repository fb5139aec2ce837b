#include "engine/volume/labels.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "engine/error.h"

namespace edgesplat {
namespace {

// Maximum share of in-between values among voxels with two distant neighbours; they occur at corners between labels.
constexpr double kMostBetween = 0.1;

/// The distinct values, ascending; empty if they are not whole numbers or too many.
std::vector<float> few_whole_numbers(const std::vector<float>& samples) {
    std::vector<float> found;
    float last = std::nanf("");
    for (const float sample : samples) {
        if (sample == last) continue;
        last = sample;
        const auto at = std::ranges::lower_bound(found, sample);
        if (at != found.end() && *at == sample) continue;
        if (sample != std::round(sample) || found.size() == kMaxLabels) return {};
        found.insert(at, sample);
    }
    return found;
}

}  // namespace

std::vector<float> labels_of(const Volume& volume) {
    std::vector<float> values = few_whole_numbers(volume.values);
    if (values.size() < 2) return {};
    const auto rank = [&](float sample) { return std::ranges::lower_bound(values, sample) - values.begin(); };
    const glm::ivec3 dims = volume.geometry.dims;
    std::uint64_t apart = 0, between = 0;
    const auto look = [&](float a, float b, float c) {
        if (a == c || std::abs(rank(a) - rank(c)) < 2) return;
        ++apart;
        if (std::min(a, c) < b && b < std::max(a, c)) ++between;
    };
    for (int z = 0; z < dims.z; ++z)
        for (int y = 0; y < dims.y; ++y)
            for (int x = 0; x < dims.x; ++x) {
                const float here = volume.at(x, y, z);
                if (x + 2 < dims.x) look(here, volume.at(x + 1, y, z), volume.at(x + 2, y, z));
                if (y + 2 < dims.y) look(here, volume.at(x, y + 1, z), volume.at(x, y + 2, z));
                if (z + 2 < dims.z) look(here, volume.at(x, y, z + 1), volume.at(x, y, z + 2));
            }
    if (static_cast<double>(between) > kMostBetween * static_cast<double>(apart)) return {};
    return values;
}

namespace {

/// The most frequent label on the volume's six sides.
std::size_t background_label(const Volume& volume, const std::vector<float>& labels) {
    std::vector<std::size_t> count(labels.size(), 0);
    const glm::ivec3 dims = volume.geometry.dims;
    for (int z = 0; z < dims.z; ++z)
        for (int y = 0; y < dims.y; ++y) {
            const bool side = z == 0 || z + 1 == dims.z || y == 0 || y + 1 == dims.y;
            for (int x = 0; x < dims.x; x += side ? 1 : std::max(dims.x - 1, 1)) {
                const auto at = std::ranges::lower_bound(labels, volume.at(x, y, z));
                ++count[static_cast<std::size_t>(at - labels.begin())];
            }
        }
    return static_cast<std::size_t>(std::ranges::max_element(count) - count.begin());
}

}  // namespace

Volume drawn_labels(const Volume& volume) {
    const std::vector<float> labels = labels_of(volume);
    if (labels.empty() || labels.size() > kMaxDrawnLabels + 1)
        fail("{}: volume.labels: expected a segmentation of 2 to {} whole numbers without transitions", volume.name,
             kMaxDrawnLabels + 1);
    const std::size_t around = background_label(volume, labels);
    bool numbered = true;
    for (std::size_t i = 0; i < labels.size(); ++i)
        numbered = numbered && (i == around || (labels[i] >= 1 && labels[i] <= float{kMaxDrawnLabels}));
    std::vector<float> drawn(labels.size(), 0.0F);
    std::size_t rank = 0;
    for (std::size_t i = 0; i < labels.size(); ++i) {
        if (i == around) continue;
        const double number = numbered ? static_cast<double>(labels[i]) : static_cast<double>(++rank);
        drawn[i] = static_cast<float>(1 + kLabelStep * number);
    }
    Volume result = volume;
    for (float& value : result.values)
        value = drawn[static_cast<std::size_t>(std::ranges::lower_bound(labels, value) - labels.begin())];
    result.notes.push_back(fmt::format("Drawn as 1 + {} / {}, and 0 where it is {}.", numbered ? "label" : "rank",
                                       std::lround(1 / kLabelStep), static_cast<double>(labels[around])));
    finish_volume(result);
    return result;
}

}  // namespace edgesplat
