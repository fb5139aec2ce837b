// Culls bricks that surfaces or saturated tiles occlude.
#pragma once

#include <span>
#include <vector>

#include "engine/plan/plan.h"

namespace edgesplat {

/// Least and largest depth of the kernels of a box's voxels, mm from the eye.
glm::dvec2 depths_of(const FramePlan& plan, const VoxelBox& box);

/// Leaves out the bricks in view that lie behind the surfaces of a mixture. `ends`: FrameParams::tile_ends, row by row.
void cull_behind(FramePlan& plan, const SplatBricks& bricks, std::span<const float> ends);

/// The unsaturated tiles of a picture, as a summed-area table.
class OpenTiles {
  public:
    /// `closed`: number of saturated pixels of each tile, row by row.
    OpenTiles(const FramePlan& plan, std::span<const std::uint32_t> closed);
    /// Whether kernels of a box's voxels may show in an unsaturated tile. Always true for a box that reaches the eye's
    /// plane.
    bool may_show(const VoxelBox& box) const;

  private:
    std::size_t corner(int x, int y) const;

    const FramePlan* plan_;
    std::vector<std::uint32_t> open_;  ///< per corner between tiles: unsaturated tiles above and left of it
};

}  // namespace edgesplat
