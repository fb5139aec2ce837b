// Segmentations: volumes whose samples are labels, not measurements.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "engine/volume/volume.h"

namespace edgesplat {

/// Maximum number of labels in a segmentation.
inline constexpr std::size_t kMaxRankedLabels = 1 << 20;

/// The labels of a segmentation: those that the reader recognised, or the volume's 2 to kMaxRankedLabels distinct
/// values, if they are whole numbers without partial-volume values. The test for these: if the two outer voxels of
/// three in a row differ by more than one step between values, the middle voxel almost never has a value between
/// theirs. More than 256 labels must also have large regions whose numbers do not grow or fall together, as measured
/// values that were enlarged without interpolation do. Null for other volumes and for volumes that are not in memory.
std::shared_ptr<const LabelTable> labels_of(const Volume& volume);

/// Whether the samples are ranks instead of numbers.
bool has_ranks(const LabelTable& table);

/// Place in the table of the label that a sample stands for; the sample must be one of the table's.
std::size_t place_of_label(const LabelTable& table, float sample);

/// Place in the table of the background: number 0 if it occurs on the volume's sides, else the most frequent label
/// there. With a segmentation of its own (segmentation.h) a volume has none: then the number of labels.
std::size_t background_label(const Volume& volume, const LabelTable& table);

/// The volume that is drawn for a segmentation, with `labels` = `table` and `shown_labels`: the mask of the voxels that
/// have a shown label, smoothed (smoothed_mask). `shown`: per place in the table. Samples without data show nothing.
/// Throws Error if no voxel has a shown label.
Volume drawn_labels(const Volume& volume, std::shared_ptr<const LabelTable> table, const std::vector<bool>& shown);

/// The same with all labels but the background. Throws Error if `labels_of` finds none.
Volume drawn_labels(const Volume& volume);

/// Shown labels with those numbers.
std::shared_ptr<const ShownLabels> sorted_labels(std::vector<std::uint32_t> at, bool on_scan = false);

/// The number of the label of voxel p: its own, else that of the nearest voxel with one, at most 2 voxels away along
/// each axis, or 1 in a scan; 0 if there is none.
std::uint32_t label_near(const ShownLabels& labels, const glm::ivec3& dims, const glm::ivec3& p);

/// The number of the label at a place, voxels, which may lie beyond the outermost ones: that of the nearest of the
/// eight voxels around it that label_near has a label for; 0 if there is none. Only of volumes with shown labels.
std::uint32_t label_at(const Volume& volume, const glm::dvec3& place);

/// Numbers in a box of the volume: `size` voxels from `low` on, x fastest.
std::vector<std::uint32_t> labels_in_box(const std::vector<std::uint32_t>& labels, const glm::ivec3& dims,
                                         const glm::ivec3& low, const glm::ivec3& size);

/// The same numbers as they are drawn: in a scan, those of label_near.
std::vector<std::uint32_t> drawn_numbers(const ShownLabels& labels, const glm::ivec3& dims, const glm::ivec3& low,
                                         const glm::ivec3& size);

/// Numbers in the volume with voxels of 2 x 2 x 2: the most frequent label in each, the lowest of several; 0 if
/// there is none.
std::vector<std::uint32_t> halved_labels(const std::vector<std::uint32_t>& labels, const glm::ivec3& dims);

}  // namespace edgesplat
