// Which parts of the list of splats a picture may show: bricks of the volume by their boxes, and boxes of such boxes.
#pragma once

#include <span>
#include <vector>

#include "engine/culling/brick_runs.h"
#include "engine/culling/view_volume.h"

namespace edgesplat {

/// Splats of a brick: they follow one another in the list.
struct SplatBrick {
    VoxelBox box;  ///< holds their voxels
    std::uint32_t first = 0, count = 0;
};

/// A part of the list, half open.
struct ListPart {
    std::uint32_t first = 0, end = 0;
    bool operator==(const ListPart&) const = default;
};

/// The bricks of a list, without those that hold nothing.
class SplatBricks {
  public:
    void clear() { levels_.clear(); }
    /// In the order of the list, which they fill from its beginning.
    void assign(std::vector<SplatBrick> bricks);
    std::size_t count() const { return levels_.empty() ? 0 : levels_.front().size(); }
    std::span<const SplatBrick> bricks() const;

    /// Numbers of the bricks that show, no kernel reaching further than `reach` voxels; ascending.
    std::vector<std::uint32_t> in_view(const ViewVolume& view, double reach) const;

    /// Parts of the list that hold the splats of these bricks, which ascend. Gaps between them are at least `least_gap`
    /// splats long.
    std::vector<ListPart> parts_of(std::span<const std::uint32_t> numbers, std::uint32_t least_gap) const;

  private:
    void add_in_view(const ViewVolume& view, double reach, std::size_t level, std::size_t node,
                     std::vector<std::uint32_t>& numbers) const;

    std::vector<std::vector<SplatBrick>> levels_;  ///< bricks, then what holds several of the level before
};

/// Parts cut into batches of at most shader::SPLAT_BATCH splats: the first one's number and how many.
std::vector<glm::uvec2> batches_of(std::span<const ListPart> parts);

}  // namespace edgesplat
