// The frame on one page: which pass runs when, on what. Passes 1 and 2, which no camera changes, are in engine/store.
#pragma once

#include <functional>
#include <optional>

#include "engine/compositors/tiles/lists.h"
#include "engine/distribute/parts.h"

namespace edgesplat {

/// A frame whose sheets are layers of a target: splat list -> pixels in `targets.output`. Runs and waits. With
/// `shadow_channel` it is the picture of a light instead: what reaches each splat goes to that half of `splat_shadows`.
std::vector<PassTime> draw_sheets(gpu::Commands& commands, const FramePlan& plan, const TargetResources& targets,
                                  std::optional<std::uint32_t> shadow_channel = {});

/// Of a frame whose sheets are summed tile by tile, passes 3 and 4 up to the sheets' order, recorded into the run that
/// is being made. `goes_on`: behind what is drawn already.
void sort_splats(gpu::Commands& commands, const FramePlan& plan, const TargetResources& targets, bool goes_on);

/// Runs that, waits, and says what is to be drawn of the part. Milliseconds are left in `commands`.
Chunks sort_frame(gpu::Commands& commands, const FramePlan& plan, const TargetResources& targets,
                  const Division& division = {});

/// The rest of that frame. `targets.tile_entries` holds the pairs of the largest chunk, `targets.chunks` the chunks.
/// With a profile's rounds each chunk is waited for, and each round where `between` is to be called after it (it may
/// throw). Of a part (`TileDraw::part`) pass 7 is left out.
std::vector<PassTime> draw_tiles(gpu::Commands& commands, const FramePlan& plan, const TargetResources& targets,
                                 std::uint32_t chunks, passes::TileDraw how, const std::function<void()>& between = {});

/// All of a tiled frame that is not refined, in one list: waits once, where the profile has no rounds. The device plans
/// FrameParams::chunk_slots chunks. What it came to; nothing where that was too few, or a chunk is too large, and the
/// picture is not whole.
std::optional<Chunks> draw_at_once(gpu::Commands& commands, const FramePlan& plan, const TargetResources& targets,
                                   passes::TileDraw how);

/// One step of `draw_tiles`, without what finishes it: of a refined picture the pixels of `step`, REFINE_STEP first,
/// then those that pass 5_refine_pixels lists; of any other all, step 1.
std::vector<PassTime> draw_step(gpu::Commands& commands, const FramePlan& plan, const TargetResources& targets,
                                std::uint32_t chunks, passes::TileDraw how, std::uint32_t step);

/// The passes of a tiled frame from its chunks on, recorded into the run that is being made.
class TilePasses {
  public:
    TilePasses(gpu::Commands& commands, const FramePlan& plan, const TargetResources& targets, std::uint32_t chunks,
               passes::TileDraw how);

    const passes::TileDraw& how() const { return how_; }
    std::uint32_t chunk_count() const { return static_cast<std::uint32_t>(parts_.size()); }
    /// Of a chunk's lists, at most.
    std::uint64_t most_pairs(std::uint32_t chunk, std::uint32_t columns = 1) const;

    void sort(std::uint32_t chunk);
    /// Unless the chunk's splats still are.
    void prepare(std::uint32_t chunk);
    /// Marks, then draws, so many tiles and groups of their pixels.
    void draw(std::uint32_t chunk, std::uint32_t step, std::uint64_t tiles, std::uint64_t groups, std::uint32_t round);
    /// For the host: pixels of tiles that take no more.
    void see_tiles();
    /// After the pixels of a step.
    void finish(std::uint32_t step);

  private:
    /// At most.
    std::uint32_t entries(std::uint32_t chunk) const {
        return how_.planned ? plan_.params.prepared_mask + 1 : parts_[chunk].y - parts_[chunk].x;
    }

    gpu::Commands& commands_;
    const FramePlan& plan_;
    const TargetResources& targets_;
    passes::TileDraw how_;
    std::span<const glm::uvec2> parts_;
    std::vector<bool> prepared_;  ///< chunks whose splats are
};

}  // namespace edgesplat
