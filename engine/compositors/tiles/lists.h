// Chooses the chunks of sheets of a tiled picture, and manages its tile lists on the host between the rounds of a
// frame.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "engine/plan/resources.h"
#include "engine/plan/sizes.h"

namespace edgesplat {

/// Chunks of a picture: each is a range of consecutive sheets that are drawn at once.
struct Chunks {
    std::vector<glm::uvec2> parts;  ///< ranges of the sorted order, half open; without empty ones
    std::uint64_t most_pairs = 0;   ///< pairs of the largest chunk
    glm::uvec2 sheets{0};           ///< the sheets drawn, half open
    std::uint64_t pairs = 0;        ///< (splat, tile) pairs of all chunks
    std::uint64_t entries = 0;      ///< entries of the order in all chunks
};

/// `pairs`: of each sheet drawn. `starts`: the index in the order where each sheet begins, then the end of the last. A
/// chunk has at most `limit` pairs and `entries` entries of the order. A sheet is never divided: a larger sheet becomes
/// a chunk of its own.
Chunks plan_chunks(std::span<const std::uint32_t> pairs, std::span<const std::uint32_t> starts, std::uint64_t limit,
                   std::uint64_t entries = ~std::uint64_t{0});

/// Upper bound of the pairs per column of a chunk: the pairs of all sheets that overlap the column. `part`: the chunk's
/// range of the order, divided into `columns` columns of equal length. `pairs` and `starts`: of all sheets.
std::uint64_t most_column_pairs(const glm::uvec2& part, std::uint32_t columns, std::span<const std::uint32_t> pairs,
                                std::span<const std::uint32_t> starts);

/// Of a sorted picture: the number of (splat, tile) pairs of each sheet; the index in the order where each sheet
/// begins, then the end of the last.
std::span<const std::uint32_t> sheet_pairs(const FramePlan& plan, const TargetResources& targets);
std::span<const std::uint32_t> sheet_starts(const FramePlan& plan, const TargetResources& targets);

/// The chunks of a sorted picture's `sheets` (half open).
Chunks chunks_of(const FramePlan& plan, const TargetResources& targets, const glm::uvec2& sheets,
                 const gpu::DeviceProfile& profile);

/// Whether the device can plan these chunks (4d_plan_chunks.comp) completely: at most `slots`, none too large.
bool fit(const Chunks& chunks, const shader::FrameParams& params, std::size_t slots);

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
