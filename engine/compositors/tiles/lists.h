// A tiled picture is drawn in chunks of sheets: which ones; and lists of tiles as the host sees them, between the
// dispatches of a frame that is drawn in rounds.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "engine/plan/resources.h"
#include "engine/plan/sizes.h"

namespace edgesplat {

/// Consecutive sheets that are drawn at once.
struct Chunks {
    std::vector<glm::uvec2> parts;  ///< of the sorted order, half open; empty ones are left out
    std::uint64_t most_pairs = 0;   ///< of any chunk
    glm::uvec2 sheets{0};           ///< the sheets that are drawn, half open
    std::uint64_t pairs = 0;        ///< of all chunks
    std::uint64_t entries = 0;      ///< of the order, in all of them
};

/// `pairs` per sheet that is drawn; `starts`: where each sheet begins in the order, and where the last one ends. A
/// sheet is never divided: one with more than `limit` pairs, or `entries` of the order, is a chunk of its own.
Chunks plan_chunks(std::span<const std::uint32_t> pairs, std::span<const std::uint32_t> starts, std::uint64_t limit,
                   std::uint64_t entries = ~std::uint64_t{0});

/// At least as many pairs as any column of a chunk has: those of all sheets that reach into it. `part` of the order,
/// divided into so many columns of equal length; `pairs` and `starts` of all sheets.
std::uint64_t most_column_pairs(const glm::uvec2& part, std::uint32_t columns, std::span<const std::uint32_t> pairs,
                                std::span<const std::uint32_t> starts);

/// Of each sheet of a picture that was sorted, pairs of a splat and a tile; where each begins in the order, and the
/// end.
std::span<const std::uint32_t> sheet_pairs(const FramePlan& plan, const TargetResources& targets);
std::span<const std::uint32_t> sheet_starts(const FramePlan& plan, const TargetResources& targets);

/// The chunks of such a picture's sheets, half open.
Chunks chunks_of(const FramePlan& plan, const TargetResources& targets, const glm::uvec2& sheets,
                 const gpu::DeviceProfile& profile);

/// Whether the device plans these chunks (4d_plan_chunks.comp), as far as there are `slots`, with nothing left out.
bool fit(const Chunks& chunks, const shader::FrameParams& params, std::size_t slots);

/// Whether drawing some pixels first (FramePlan::refined) saves time: splats are some pixels wide.
bool worth_refining(const Chunks& chunks);

/// The first of a picture's steps; each is half of the one before, the last is 1.
std::uint32_t first_step(const FramePlan& plan);

/// How many pixels of each tile are drawn first.
void fill_todo(const FramePlan& plan, const TargetResources& targets);

/// Tiles, and groups of their pixels, by the length of the tile's list, so that a round goes to those alone that it has
/// something for: FrameParams::tile_order.
class TileOrder {
  public:
    /// `group`: pixels of a workgroup.
    TileOrder(const FramePlan& plan, const TargetResources& targets, std::uint32_t group);

    /// After a chunk's lists were made; `groups` of every tile at most.
    void sort(std::uint32_t groups);
    void clear();

    /// Groups whose lists go on in that round of TILE_ROUND entries: the first so many; and their tiles.
    std::size_t groups_in(std::uint32_t round) const;
    std::size_t tiles_in(std::uint32_t round) const;

    /// Whether any pixel is to be drawn.
    bool any_todo() const;

  private:
    std::uint32_t length(std::uint32_t tile) const { return ranges_[tile].y - ranges_[tile].x; }
    std::span<const glm::uvec2> ranges_;
    std::span<const std::uint32_t> todo_;
    std::span<std::uint32_t> tiles_, order_;
    std::uint32_t group_;
    std::vector<std::uint32_t> sorted_;  ///< tiles that something is drawn of, longest list first
    std::vector<std::size_t> ends_;      ///< of their groups in `order_`
};

/// Lists of the tiles of chunks that are kept for the next step of a refined picture.
class KeptLists {
  public:
    KeptLists(const FramePlan& plan, const TargetResources& targets, std::size_t chunks);

    /// The chunk's lists are about to be made, of at most so many pairs: says where. Others may have to make room.
    void place(std::uint32_t chunk, std::uint64_t pairs);
    /// They are made.
    void keep(std::uint32_t chunk);
    /// Puts them back, if they are there and hold all that is still to be drawn.
    bool take(std::uint32_t chunk);

  private:
    struct Lists {
        std::uint64_t begin = 0, end = 0;  ///< pairs in `tile_entries`
        std::vector<glm::uvec2> ranges;    ///< empty: not kept
        std::vector<bool> left_out;        ///< tiles that were closed
    };

    bool is_closed(std::size_t tile) const;
    void point_to(std::uint64_t pair) const;

    std::size_t tiles_;
    const TargetResources& targets_;
    std::vector<Lists> lists_;
    std::uint64_t used_ = 0;
};

}  // namespace edgesplat
