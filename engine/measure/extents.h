// How much of each material a volume holds, and how large the surfaces between them are.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "engine/reference/pixel_rows.h"
#include "engine/scene/effects.h"
#include "engine/volume/volume.h"

namespace edgesplat::measure {

/// A measured number and how far from it the true one may lie, either way.
struct Quantity {
    double value = 0;
    double uncertainty = 0;
};

struct Extents {
    std::vector<Quantity> volumes;   ///< mm^3, of each material: below the first iso-value, ..., from the last one up
    std::vector<Quantity> surfaces;  ///< mm^2, of each iso-value; what clip planes or the volume's side cut is none
};

/// Materials are what faces show of them: divided where the cubic B-spline through the samples crosses an iso-value,
/// within half a voxel around the outermost samples, and only where `clip` keeps them. Found along four lines a voxel
/// and axis, on which each crossing is exact.
///
/// The uncertainty is twice the difference from what trilinear interpolation has; and as much as all crossings moved
/// the same way by what quantisation, and edges sharper than samples can show, leave open (value_uncertainty); and
/// what lines along the three axes disagree. A surface has the slope over a voxel, and what the contour itself has more
/// than that is uncertain, too. Noise makes surfaces larger than they are, of which samples do not tell.
///
/// `iso_values` ascend. Throws Error for a volume that is not in memory, and Cancelled.
Extents measure_extents(const Volume& volume, std::span<const double> iso_values, const Clip& clip = {},
                        const reference::Progress& progress = {});

/// Things of a segmentation by their labels, ascending.
struct LabelExtent {
    double label = 0;
    std::size_t voxels = 0;
    Quantity volume;  ///< mm^3: of its voxels; half of those with another label beside them are uncertain
};

/// Throws Error for a volume that is not in memory.
std::vector<LabelExtent> measure_labels(const Volume& volume);

}  // namespace edgesplat::measure
