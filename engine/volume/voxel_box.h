// An axis-aligned box of voxels.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>

namespace edgesplat {

/// Both ends are inclusive; empty by default.
struct VoxelBox {
    glm::ivec3 low{0}, high{-1};

    bool empty() const { return high.x < low.x; }
    glm::ivec3 size() const { return high - low + 1; }
    std::uint64_t count() const {
        const glm::u64vec3 n(size());
        return n.x * n.y * n.z;
    }
    /// The slice of the box at one z.
    VoxelBox slice(int z) const { return {{low.x, low.y, z}, {high.x, high.y, z}}; }
    VoxelBox widened(int by) const { return {low - by, high + by}; }

    /// Extends this box so that it contains `other`.
    void add(const VoxelBox& other) {
        if (other.empty()) return;
        low = empty() ? other.low : glm::min(low, other.low);
        high = empty() ? other.high : glm::max(high, other.high);
    }
};

}  // namespace edgesplat
