// Draws a tiled frame in rounds, between which the host reads the tile lists: for drivers that end long loops.
#pragma once

#include <functional>

#include "engine/frame/tiles/tile_passes.h"

namespace edgesplat {

/// Runs what follows the sort of a frame (draw_tiles()) and waits after each chunk; with `between` after each round,
/// too, and then calls it.
std::vector<PassTime> draw_in_rounds(gpu::Commands& commands, const FramePlan& plan, const TargetResources& targets,
                                     TilePasses& frame, const std::function<void()>& between);

}  // namespace edgesplat
