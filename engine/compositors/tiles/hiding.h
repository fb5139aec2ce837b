// What closed tiles hide; and a frame in two parts, what is in front, then of the rest what is not hidden behind it.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "engine/plan/plan.h"

namespace edgesplat {

/// Bricks in view by number, ascending. Those that reach across the sheet are among both.
struct FrontAndRest {
    int sheet = 0;  ///< numbered from the eye on: in front of it are about half of the splats
    std::vector<std::uint32_t> front, rest;
};

/// Nothing where that would save little: fewer splats in view than `least`, large ones, pixels that never close.
std::optional<FrontAndRest> divide_front(const FramePlan& plan, const SplatBricks& bricks, std::uint64_t least);

/// The tiles of a picture that take more, and what may show in them.
class OpenTiles {
  public:
    /// `closed`: of each tile, row by row, pixels that take no more.
    OpenTiles(const FramePlan& plan, std::span<const std::uint32_t> closed);
    /// Whether kernels of the voxels in a box may show in one of them. Never false for a box that reaches the eye's
    /// plane.
    bool may_show(const VoxelBox& box) const;

  private:
    std::size_t corner(int x, int y) const;

    const FramePlan* plan_;
    std::vector<std::uint32_t> open_;  ///< how many of them lie above and left of each corner between tiles
};

}  // namespace edgesplat
