// The rows of voxels that hold splats, from runs of consecutive voxels.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>

namespace edgesplat {

/// Inclusive box of whole rows around all runs that were added; the whole volume before.
class RowBox {
  public:
    explicit RowBox(const glm::ivec3& dims) : dims_(dims), low_(dims), high_(-1) {}

    /// A run by its first and last linear voxel index.
    void add(std::uint64_t first, std::uint64_t last) {
        const auto nx = static_cast<std::uint64_t>(dims_.x), ny = static_cast<std::uint64_t>(dims_.y);
        const glm::ivec3 a(0, first / nx % ny, first / nx / ny), b(dims_.x - 1, last / nx % ny, last / nx / ny);
        // A run that spans slices spans every row between them.
        const bool wraps = a.z != b.z;
        low_ = glm::min(low_, glm::ivec3(0, wraps ? 0 : a.y, a.z));
        high_ = glm::max(high_, glm::ivec3(b.x, wraps ? dims_.y - 1 : b.y, b.z));
    }

    glm::ivec3 low() const { return empty() ? glm::ivec3(0) : low_; }
    glm::ivec3 high() const { return empty() ? dims_ - 1 : high_; }

  private:
    bool empty() const { return high_.x < 0; }

    glm::ivec3 dims_, low_, high_;
};

}  // namespace edgesplat
