// Divides a field into lines along an axis, for filters that work axis by axis. Internal to engine/volume, not
// installed.
#pragma once

#include <cstddef>
#include <glm/glm.hpp>
#include <vector>

#include "engine/volume/parallel.h"

namespace edgesplat::detail {

/// Lines side by side in memory: first the first sample of each line, then the second of each, and so on.
struct Lines {
    float* samples;
    std::size_t count;   ///< lines
    std::size_t length;  ///< samples of a line
    std::size_t stride;  ///< between successive samples of a line
    float* sample(std::size_t i) const { return samples + i * stride; }
};

/// Calls `work(lines)` for all lines of `field` (x fastest) along an axis, in parallel.
template <typename Work>
void along_axis(std::vector<float>& field, const glm::ivec3& dims, int axis, const Work& work) {
    const auto row = static_cast<std::size_t>(dims.x), slice = row * static_cast<std::size_t>(dims.y);
    const auto length = static_cast<std::size_t>(dims[axis]), stride = axis == 0 ? 1 : axis == 1 ? row : slice;
    const std::size_t together = axis == 0 ? 1 : row, apart = axis == 1 ? slice : row;
    parallel_for(static_cast<int>(field.size() / (length * together)), [&](int begin, int end) {
        for (auto group = static_cast<std::size_t>(begin); group < static_cast<std::size_t>(end); ++group)
            work(Lines{field.data() + group * apart, together, length, stride});
    });
}

}  // namespace edgesplat::detail
