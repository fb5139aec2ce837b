// Culls bricks that saturated tiles occlude: divides a frame into a front part and the rest, and tests which bricks of
// the rest are still visible.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "engine/plan/plan.h"

namespace edgesplat {

/// Bricks in view by number, ascending. Bricks that reach across the sheet are in both lists.
struct FrontAndRest {
    int sheet = 0;  ///< numbered from the eye on; about half of the splats are in front of it
    std::vector<std::uint32_t> front, rest;
};

/// nullopt if the division would save little: fewer than `least` splats in view, large splats, or pixels that never
/// saturate.
std::optional<FrontAndRest> divide_front(const FramePlan& plan, const SplatBricks& bricks, std::uint64_t least);

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
