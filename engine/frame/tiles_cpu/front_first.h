// Divides a frame into a front part and the rest. Of the rest, only bricks are drawn that the front part leaves
// visible.
#pragma once

#include <optional>
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

}  // namespace edgesplat
