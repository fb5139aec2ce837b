// The range of the samples in and around each brick of a volume: where no matter ends, no edge is estimated.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "engine/volume/volume.h"

namespace edgesplat {

/// For bricks of BRICK^3 voxels, numbered with x fastest. Does not depend on the iso-values.
class BrickRanges {
  public:
    BrickRanges() = default;
    /// Of a volume with samples. Takes one pass over them, on all processors.
    explicit BrickRanges(const Volume& volume);

    bool empty() const { return bricks_.empty(); }
    /// Number of each brick, with BRICK_ENDS if matter may end in it: if its samples, those up to 3 voxels beside it,
    /// and the field at the volume's border beside it are of more than one material, or some are missing. `iso`:
    /// scaled, ascending. With `only_ends` without the other bricks.
    std::vector<std::uint32_t> list(std::span<const float> iso, bool only_ends) const;

  private:
    struct Range {
        float least, most;  ///< scaled; least < 0: a sample is missing
    };
    std::vector<Range> bricks_;
};

}  // namespace edgesplat
