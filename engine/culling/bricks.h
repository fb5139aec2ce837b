// Finds the parts of the splat list that a picture may show, in a hierarchy of bricks' bounding boxes.
#pragma once

#include <span>
#include <vector>

#include "engine/culling/brick_runs.h"
#include "engine/culling/view_volume.h"

namespace edgesplat {

/// Splats of a brick, consecutive in the list.
struct SplatBrick {
    VoxelBox box;  ///< bounding box of their voxels
    std::uint32_t first = 0, count = 0;
};

/// A part of the list, half open.
struct ListPart {
    std::uint32_t first = 0, end = 0;
    bool operator==(const ListPart&) const = default;
};

/// The bricks of a list, without empty ones.
class SplatBricks {
  public:
    void clear() { levels_.clear(); }
    /// `bricks` in the order of the list, covering it from its beginning.
    void assign(std::vector<SplatBrick> bricks);
    std::size_t count() const { return levels_.empty() ? 0 : levels_.front().size(); }
    std::span<const SplatBrick> bricks() const;

    /// Numbers of the bricks in view, ascending. `reach`: farthest reach of any kernel, voxels.
    std::vector<std::uint32_t> in_view(const ViewVolume& view, double reach) const;

    /// Parts of the list with the splats of these bricks (ascending numbers). Gaps of less than `least_gap` splats are
    /// included.
    std::vector<ListPart> parts_of(std::span<const std::uint32_t> numbers, std::uint32_t least_gap) const;

  private:
    void add_in_view(const ViewVolume& view, double reach, std::size_t level, std::size_t node,
                     std::vector<std::uint32_t>& numbers) const;

    std::vector<std::vector<SplatBrick>> levels_;  ///< bricks, then nodes that each join 8 of the level before
};

/// Parts cut into batches (first splat, count) of at most shader::SPLAT_BATCH splats.
std::vector<glm::uvec2> batches_of(std::span<const ListPart> parts);

}  // namespace edgesplat
