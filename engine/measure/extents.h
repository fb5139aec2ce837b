// Measures the volume of each material and the area of each iso-surface.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "engine/reference/pixel_rows.h"
#include "engine/scene/effects.h"
#include "engine/volume/volume.h"

namespace edgesplat::measure {

/// A measured value and its uncertainty (+-).
struct Quantity {
    double value = 0;
    double uncertainty = 0;
};

struct Extents {
    std::vector<Quantity> volumes;  ///< mm^3 per material: below the first iso-value, ..., from the last iso-value up
    /// mm^2 per iso-value; cuts by clip planes and by the volume's border do not count
    std::vector<Quantity> surfaces;
};

/// Materials are bounded by the iso-surfaces of the cubic B-spline through the samples, by half a voxel around the
/// outermost samples, by voxels without data, and by `clip`. Lengths are measured along 2 x 2 lines per voxel and axis;
/// each crossing is exact.
///
/// The uncertainty of a volume has three parts: twice the difference from trilinear interpolation; a common shift of
/// all crossings by quantisation and by edges too sharp for the sampling (value_uncertainty); and the disagreement
/// between the three axes. The area uses the slope over a voxel. The excess area of the spline's own contour counts as
/// uncertainty, too. Noise enlarges areas, which samples cannot reveal.
///
/// `iso_values` ascend. Throws Error for a volume that is not in memory, and Cancelled.
Extents measure_extents(const Volume& volume, std::span<const double> iso_values, const Clip& clip = {},
                        const reference::Progress& progress = {});

/// One label of a segmentation.
struct LabelExtent {
    Label label;
    std::string number;      ///< the file's number
    std::size_t voxels = 0;  ///< voxels whose centre is kept
    Quantity volume;         ///< mm^3; half of the voxels next to another label are uncertain
    /// Mean and standard deviation of a scan's samples in the label, in the file's unit; not set: no samples with data,
    /// or a segmentation alone.
    std::optional<glm::dvec2> values;
};

/// The labels of a volume from drawn_labels or with a segmentation, or all labels of another volume (labels_of; every
/// distinct value if it is no segmentation), by ascending number; inside `clip`, which cuts voxels. Throws Error for a
/// volume that is not in memory.
std::vector<LabelExtent> measure_labels(const Volume& volume, const Clip& clip = {});

}  // namespace edgesplat::measure
