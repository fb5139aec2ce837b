#include "engine/volume/labels.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace edgesplat {
namespace {

// Of the voxels between two of far apart values, those that may lie between them: corners where labels meet.
constexpr double kMostBetween = 0.1;

/// The values, ascending; empty where they are not whole numbers or too many.
std::vector<float> few_whole_numbers(const std::vector<float>& samples) {
    std::vector<float> found;
    float last = std::nanf("");
    for (const float sample : samples) {
        if (sample == last) continue;
        last = sample;
        const auto at = std::ranges::lower_bound(found, sample);
        if (at != found.end() && *at == sample) continue;
        if (sample != std::round(sample) || found.size() == kMostLabels) return {};
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

}  // namespace edgesplat
