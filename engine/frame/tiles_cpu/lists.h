// A tiled picture whose lists the host reads between rounds: which tiles and pixels are drawn next, and which lists are
// kept.
#pragma once

#include "engine/frame/tiles/chunks.h"

namespace edgesplat {

/// Whether refinement (FramePlan::refined) saves time: only if splats are several pixels wide.
bool should_refine(const Chunks& chunks);

/// The first of a picture's refinement steps; each step is half of the one before, the last is 1.
std::uint32_t first_step(const FramePlan& plan);

/// Writes how many pixels of each tile the first step draws.
void fill_todo(const FramePlan& plan, const TargetResources& targets);

/// FrameParams::tile_order: tiles, then groups of their pixels, longest tile list first. A round thus dispatches only
/// the tiles whose lists reach it.
class TileOrder {
  public:
    /// `group`: pixels of a workgroup.
    TileOrder(const FramePlan& plan, const TargetResources& targets, std::uint32_t group);

    /// Call after a chunk's lists are built. `groups`: upper bound per tile.
    void sort(std::uint32_t groups);
    void clear();

    /// Number of groups, and of tiles, whose lists reach that round; they come first in the order.
    std::size_t groups_in(std::uint32_t round) const;
    std::size_t tiles_in(std::uint32_t round) const;

    /// Whether any pixel remains to be drawn.
    bool has_pixels_to_draw() const;

  private:
    std::uint32_t length(std::uint32_t tile) const { return ranges_[tile].y - ranges_[tile].x; }
    std::span<const glm::uvec2> ranges_;
    std::span<const std::uint32_t> todo_;
    std::span<std::uint32_t> tiles_, order_;
    std::uint32_t group_;
    std::vector<std::uint32_t> sorted_;  ///< tiles with entries and pixels to draw, longest list first
    std::vector<std::size_t> ends_;      ///< end of each one's groups in `order_`
};

/// Tile lists of chunks, kept for the next step of a refined picture.
class KeptLists {
  public:
    KeptLists(const FramePlan& plan, const TargetResources& targets, std::size_t chunks);

    /// Reserves room for a chunk's lists of at most `pairs` pairs before they are built; may discard other lists.
    void place(std::uint32_t chunk, std::uint64_t pairs);
    /// Records the chunk's lists after they are built.
    void keep(std::uint32_t chunk);
    /// Restores the chunk's lists. Returns false if they are not kept or lack a tile that must still be drawn.
    bool take(std::uint32_t chunk);

  private:
    struct Lists {
        std::uint64_t begin = 0, end = 0;  ///< pairs in `tile_entries`
        std::vector<glm::uvec2> ranges;    ///< empty: not kept
        std::vector<bool> left_out;        ///< tiles without a list since they were saturated
    };

    bool is_closed(std::size_t tile) const;
    void point_to(std::uint64_t pair) const;

    std::size_t tiles_;
    const TargetResources& targets_;
    std::vector<Lists> lists_;
    std::uint64_t used_ = 0;
};

}  // namespace edgesplat
