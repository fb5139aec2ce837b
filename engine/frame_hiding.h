// A frame in two parts: what is in front, then of the rest the bricks that are not hidden behind it.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "engine/frame_plan.h"

namespace edgesplat {

/// Bricks in view by number, ascending. Those that reach across the sheet are among both.
struct FrontAndRest {
    int sheet = 0;  ///< numbered from the eye on: in front of it are about half of the splats
    std::vector<std::uint32_t> front, rest;
};

/// Nothing where that would save little: fewer splats in view than `least`, large ones, pixels that never close.
std::optional<FrontAndRest> divide_front(const FramePlan& plan, const SplatBricks& bricks, std::uint64_t least);

/// Those of `rest` of which a tile may show something. `closed`: pixels of each tile that take no more.
std::vector<std::uint32_t> not_hidden(const FramePlan& plan, const SplatBricks& bricks,
                                      std::span<const std::uint32_t> rest, std::span<const std::uint32_t> closed);

}  // namespace edgesplat
