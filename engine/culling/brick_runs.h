// Divides voxels for 2_collect_splats: into bricks, and these into slices. A slice of a brick is one invocation's run.
#pragma once

#include <algorithm>
#include <cstdint>
#include <glm/glm.hpp>

#include "engine/volume/voxel_box.h"
#include "shaders/shared/limits.h"

namespace edgesplat {

/// The runs of a box of voxels, numbered by brick along x, then along y, then by slice.
class BrickRuns {
  public:
    explicit BrickRuns(const glm::ivec3& size)
        : size_(size),
          bricks_((size + kSide - 1) / kSide),
          in_slice_(std::uint64_t(bricks_.x) * std::uint64_t(bricks_.y)) {}

    std::uint64_t bricks() const { return in_slice_ * static_cast<std::uint64_t>(bricks_.z); }
    std::uint64_t count() const { return in_slice_ * static_cast<std::uint64_t>(size_.z); }

    /// Calls body(box, first_run, stride) for every brick in the order of the splat list: its box of voxels, the number
    /// of its first run, and the difference between the run numbers of adjacent slices.
    template <class Body>
    void each_brick(const Body& body) const {
        for (int z = 0; z < bricks_.z; ++z)
            for (int y = 0; y < bricks_.y; ++y)
                for (int x = 0; x < bricks_.x; ++x) {
                    const glm::ivec3 low = glm::ivec3(x, y, z) * kSide, high = glm::min(low + kSide, size_) - 1;
                    const std::uint64_t first = in_slice_ * static_cast<std::uint64_t>(low.z) +
                                                static_cast<std::uint64_t>(y) * static_cast<std::uint64_t>(bricks_.x) +
                                                static_cast<std::uint64_t>(x);
                    body(VoxelBox{low, high}, first, in_slice_);
                }
    }

  private:
    static constexpr int kSide = static_cast<int>(shader::BRICK);
    glm::ivec3 size_, bricks_;
    std::uint64_t in_slice_;
};

}  // namespace edgesplat
