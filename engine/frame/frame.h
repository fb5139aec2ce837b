// Runs passes 3 to 7 of a frame. Passes 1 and 2, which do not depend on the camera, are in engine/store.
#pragma once

#include <functional>
#include <limits>

#include "engine/frame/tiles/chunks.h"
#include "engine/passes/5_draw_tiles.h"

namespace edgesplat {

/// Draws a frame whose sheets are layers of a target: splat list -> pixels in `targets.output`. Runs and waits.
std::vector<PassTime> draw_layers(gpu::Commands& commands, const FramePlan& plan, const TargetResources& targets);

/// Sheets to draw, numbered from the eye on, half open.
struct SheetRange {
    int begin = 0, end = std::numeric_limits<int>::max();
    bool continues = false;  ///< continues behind sheets that are drawn already

    /// The sheets, numbered from the picture's first sheet on.
    glm::uvec2 in_picture(const shader::FrameParams& params) const;
};

/// Runs sort_splats(), waits and returns the chunks of the range's sheets. The times are left in `commands`.
Chunks sort_frame(gpu::Commands& commands, const FramePlan& plan, const TargetResources& targets,
                  const SheetRange& range = {});

/// Draws that frame after the sort. `targets.tile_entries` must have room for the largest chunk's pairs,
/// `targets.chunks` the chunks. If the profile has rounds, the host waits after each chunk, and with `between` after
/// each round, then calls it (it may throw). A part (`TileDraw::part`) skips pass 7.
std::vector<PassTime> draw_tiles(gpu::Commands& commands, const FramePlan& plan, const TargetResources& targets,
                                 std::uint32_t chunks, passes::TileDraw how, const std::function<void()>& between = {});

/// Draws a tiled frame without refinement in one command list and waits once; only for profiles without rounds. The
/// device plans FrameParams::chunk_slots chunks. Returns the chunks; nullopt if there are more than that or one is too
/// large: then the picture is incomplete.
std::optional<Chunks> draw_at_once(gpu::Commands& commands, const FramePlan& plan, const TargetResources& targets,
                                   passes::TileDraw how);

/// Ends a picture of several volumes without kernels: composites their surfaces and runs pass 7. `plan`: of the part
/// that was drawn last. Runs and waits.
std::vector<PassTime> join_volumes(gpu::Commands& commands, const FramePlan& plan, const TargetResources& targets);

}  // namespace edgesplat
