// A volume and its coarser resolutions, each computed on first use.
#pragma once

#include <memory>
#include <vector>

#include "engine/volume/volume.h"

namespace edgesplat {

class VolumeLevels {
  public:
    /// Null: no volume.
    void set(std::shared_ptr<const Volume> volume);
    const std::shared_ptr<const Volume>& original() const { return levels_.front(); }
    /// The volume with voxels of 2^level original voxels along each axis; without samples if the original has none.
    /// Valid until the next set().
    const std::shared_ptr<const Volume>& at(int level);
    int count() const;
    /// The finest level of at most kCoarseVoxels voxels, or the coarsest level.
    int coarse() const;

  private:
    std::vector<std::shared_ptr<const Volume>> levels_{nullptr};
};

/// A level with at most this many voxels is uploaded almost at once.
inline constexpr std::size_t kCoarseVoxels = std::size_t{1} << 17U;

}  // namespace edgesplat
