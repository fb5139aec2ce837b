// Records the passes of a tiled frame.
#pragma once

#include "engine/frame/tiles/chunks.h"
#include "engine/passes/5_draw_tiles.h"

namespace edgesplat {

/// Records passes 3 and 4 of a tiled frame, up to the order of sheets, into the current run. `continues`: the frame
/// continues behind sheets that are drawn already, so that the picture is kept.
void sort_splats(gpu::Commands& commands, const FramePlan& plan, const TargetResources& targets, bool continues);

/// Records what ends a picture, after all its parts: surfaces behind kernels, and pass 7.
void end_picture(gpu::Commands& commands, const FramePlan& plan, const TargetResources& targets);
/// The same of several volumes: also composites their surfaces first.
void end_picture_of_volumes(gpu::Commands& commands, const FramePlan& plan, const TargetResources& targets);

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
