// Where two volumes differ, so that what was found of the one need not be found again for the other.
#pragma once

#include <optional>

#include "engine/volume/volume.h"
#include "engine/volume/voxel_box.h"

namespace edgesplat {

/// The smallest box that holds every sample in which `now` is not what `before` was, empty if there is none.
/// Nothing where all may differ: grids are not the same, ranges of values are not (to which samples are scaled), or
/// either's samples are not in memory.
std::optional<VoxelBox> changed_box(const Volume& before, const Volume& now);

}  // namespace edgesplat
