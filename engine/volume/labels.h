// Segmentations: volumes whose samples name things instead of measuring them.
#pragma once

#include <cstddef>
#include <vector>

#include "engine/volume/volume.h"

namespace edgesplat {

/// The most values that a segmentation is taken to have.
inline constexpr std::size_t kMostLabels = 256;

/// The labels of a segmentation, ascending: at least two whole numbers, few of them, and no partial volume: where two
/// voxels that have one between them differ by more than a step from value to value, that one is hardly ever of a
/// value between theirs. Empty for any other volume, and for one that is not in memory.
std::vector<float> labels_of(const Volume& volume);

}  // namespace edgesplat
