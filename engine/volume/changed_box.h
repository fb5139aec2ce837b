// Finds the box in which two volumes differ, so that only edges near it are estimated again.
#pragma once

#include <optional>

#include "engine/volume/volume.h"
#include "engine/volume/voxel_box.h"

namespace edgesplat {

/// The smallest box that contains every differing sample; empty if there is none. nullopt if the volumes cannot be
/// compared: grids or value ranges differ (samples are scaled by the range), or samples are not in memory.
std::optional<VoxelBox> changed_box(const Volume& before, const Volume& now);

}  // namespace edgesplat
