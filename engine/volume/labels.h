// Segmentations: volumes whose samples are labels, not measurements.
#pragma once

#include <cstddef>
#include <vector>

#include "engine/volume/volume.h"

namespace edgesplat {

/// Maximum number of labels in a segmentation.
inline constexpr std::size_t kMaxLabels = 256;

/// Maximum number of labels whose numbers are kept although floats cannot represent them (Volume::labels).
inline constexpr std::size_t kMaxRankedLabels = 1 << 20;

/// The labels of a segmentation, ascending: 2 to kMaxLabels whole numbers without partial-volume values. The test for
/// these: if the two outer voxels of three in a row differ by more than one step between values, the middle voxel
/// almost never has a value between theirs. Empty for other volumes and for volumes that are not in memory.
std::vector<float> labels_of(const Volume& volume);

/// Labels are drawn as 1 + kLabelStep * number, so that the common surface of all labels lies at about 0.5 for every
/// number.
inline constexpr double kLabelStep = 1.0 / 1024;
/// Maximum number of labels that get their own colour.
inline constexpr std::size_t kMaxDrawnLabels = 250;

/// The volume that is drawn for a segmentation: 0 for the background (the most frequent label at the volume's border),
/// else 1 + kLabelStep * number. The number is the label if all labels are from 1 to kMaxDrawnLabels, else its rank,
/// from 1. Throws Error if `labels_of` finds none or too many.
Volume drawn_labels(const Volume& volume);

}  // namespace edgesplat
