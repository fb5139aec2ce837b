// A volume as it was set, and its coarser resolutions, each made when it is first asked for.
#pragma once

#include <memory>
#include <vector>

#include "engine/volume/volume.h"

namespace edgesplat {

class VolumeLevels {
  public:
    /// Null: there is none.
    void set(std::shared_ptr<const Volume> volume);
    const std::shared_ptr<const Volume>& original() const { return levels_.front(); }
    /// Voxels of 2^level along each axis; without samples where the original has none. Those of one call last until the
    /// next set().
    const std::shared_ptr<const Volume>& at(int level);
    int count() const;
    /// The finest level that is on the device in a moment.
    int coarse() const;

  private:
    std::vector<std::shared_ptr<const Volume>> levels_{nullptr};
};

/// A level of no more voxels is on the device in a moment.
inline constexpr std::size_t kCoarseVoxels = std::size_t{1} << 17U;

}  // namespace edgesplat
