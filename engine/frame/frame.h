// Records and runs passes 3 to 7 of a frame; rounds.cpp decides their order. Passes 1 and 2, which do not depend on the
// camera, are in engine/store.
#pragma once

#include <functional>
#include <limits>

#include "engine/compositors/tiles/lists.h"

namespace edgesplat {

/// Draws a frame whose sheets are layers of a target: splat list -> pixels in `targets.output`. Runs and waits.
std::vector<PassTime> draw_sheets(gpu::Commands& commands, const FramePlan& plan, const TargetResources& targets);

/// Records passes 3 and 4 of a tiled frame, up to the order of sheets, into the current run. `continues`: the frame
/// continues behind sheets that are drawn already, so that the picture is kept.
void sort_splats(gpu::Commands& commands, const FramePlan& plan, const TargetResources& targets, bool continues);

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

/// Records the passes of a tiled frame that follow the choice of chunks into the current run.
class TilePasses {
  public:
    TilePasses(gpu::Commands& commands, const FramePlan& plan, const TargetResources& targets, std::uint32_t chunks,
               passes::TileDraw how);

    const passes::TileDraw& how() const { return how_; }
    std::uint32_t chunk_count() const { return static_cast<std::uint32_t>(parts_.size()); }
    /// Upper bound of pairs per column of a chunk's lists.
    std::uint64_t most_pairs(std::uint32_t chunk, std::uint32_t columns = 1) const;

    void sort(std::uint32_t chunk);
    /// Skipped if the chunk's splats are still prepared.
    void prepare(std::uint32_t chunk);
    /// Marks, then draws, `tiles` tiles and `groups` groups of their pixels.
    void draw(std::uint32_t chunk, std::uint32_t step, std::uint64_t tiles, std::uint64_t groups, std::uint32_t round);
    /// Copies the count of saturated pixels of each tile to the host.
    void copy_saturated_to_host();
    /// Records what follows a step: shading of surface splats, refinement after steps above 1, pass 7 after the last.
    void finish(std::uint32_t step);

  private:
    /// Shades the surfaces that the step's pixels show; only with surface splats.
    void shade(std::uint32_t step);
    /// Upper bound of a chunk's entries of the order.
    std::uint32_t entries(std::uint32_t chunk) const {
        return how_.planned ? plan_.params.prepared_mask + 1 : parts_[chunk].y - parts_[chunk].x;
    }

    gpu::Commands& commands_;
    const FramePlan& plan_;
    const TargetResources& targets_;
    passes::TileDraw how_;
    std::span<const glm::uvec2> parts_;
    std::vector<bool> prepared_;  ///< by chunk: its splats are prepared
};

}  // namespace edgesplat
