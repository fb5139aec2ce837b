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

/// Voxels of the numbers that things have are drawn as this above 1, so that the surface of all things together is at
/// about 0.5 whatever their numbers are.
inline constexpr double kLabelStep = 1.0 / 1024;
/// The most things that are drawn each in a colour of its own.
inline constexpr std::size_t kMostDrawnLabels = 250;

/// A segmentation as it is drawn: 0 where nothing is, which is the label that most voxels at the volume's border have,
/// else 1 + kLabelStep times the thing's number. That is its label where all are whole numbers from 1 to
/// kMostDrawnLabels, else its rank, from 1. Throws Error where `labels_of` finds none or too many.
Volume drawn_labels(const Volume& volume);

}  // namespace edgesplat
