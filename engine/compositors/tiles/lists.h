// Lists of tiles as the host sees them, between the dispatches of a frame that is drawn in rounds.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "engine/plan/plan.h"
#include "engine/plan/resources.h"

namespace edgesplat {

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
