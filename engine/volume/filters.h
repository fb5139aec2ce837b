// Preprocessing of volumes, and statistics that help to choose iso-values.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <vector>

#include "engine/volume/volume.h"
#include "engine/volume/voxel_box.h"

namespace edgesplat {

/// Mean over 3x3x3 voxels (clamped at the border), the preprocessing the paper uses on binary data. Geometry, name and
/// notes are kept; the result is finished.
Volume box_filter(const Volume& volume);

/// 1 where the sample is >= `iso_value`, else 0. Geometry, name and notes are kept; the result is finished.
Volume threshold(const Volume& volume, double iso_value);

/// Voxels low to high, both included; positions in the world stay what they were. Throws Error unless it lies in the
/// volume and has at least 2 voxels along each axis.
Volume cropped(const Volume& volume, const glm::ivec3& low, const glm::ivec3& high);

/// The scaled field of docs/method.md: F = (f - f_min) / (f_max - f_min) computed in double, kept as float; all 0 where
/// the volume is constant. Same order as `Volume::values`.
std::vector<float> scaled_field(const Volume& volume);
/// The same of a part of it.
std::vector<float> scaled_box(const Volume& volume, const VoxelBox& box);
/// The same scaling for one value, e.g. a point of a transfer function; may lie outside [0, 1]. 0 where the volume is
/// constant.
double scaled_value(const Volume& volume, double value);

/// The same for an iso-value; one that no sample lies on the other side of is +-1e9, where no estimator of edges
/// extrapolates to it.
double scaled_iso_value(const Volume& volume, double iso_value);

/// Coefficients of the cubic B-spline that goes through `field` (x fastest), without second derivatives at the borders:
/// what the `cubic` edge estimator interpolates. Same size and order as `field`. Throws Error when dims and field
/// disagree.
std::vector<float> bspline_coefficients(const std::vector<float>& field, const glm::ivec3& dims);

/// The four coefficients beside a place of that spline on one axis, and their weights in its value and its slope.
struct SplineTaps {
    std::array<double, 4> weights{}, slopes{};
    std::array<int, 4> places{};  ///< one beyond a border has no weight
};
/// Any `place`: beyond the outermost samples the spline goes on straight. size >= 1.
SplineTaps spline_taps(double place, int size);

struct Histogram {
    double low = 0, high = 0;  ///< value range; bin i covers low + [i, i+1) * (high - low) / bins, the last one closed
    std::vector<std::size_t> counts;
    double center(std::size_t bin) const {
        return low + (static_cast<double>(bin) + 0.5) * (high - low) / static_cast<double>(counts.size());
    }
};

/// Counts of all samples in `bins` >= 1 equal bins from the smallest to the largest. A constant volume has all in bin
/// 0. A packed volume's are added up from the bins in its file: exact where their number is a multiple of `bins`.
Histogram histogram(const Volume& volume, int bins);

struct IsoSuggestion {
    double value = 0;     ///< in the volume's unit
    double strength = 0;  ///< how much of it is seen, how steep and how smooth it is, relative to the strongest, (0, 1]
};

/// Values at which surfaces are worth looking at: of the surfaces that rays along the axes meet first from outside, the
/// share of rays that meet one, times its mean gradient magnitude, times the sixth power of how well the gradients on
/// both sides of it agree in direction; peaks of that over the value axis. What pads a measured cylinder has no
/// surface. Halfway between neighbouring values where there are few (masks, labels). Strongest first, at most `count`;
/// empty for a constant volume. A packed volume's are those of its finest level of at most `kMaxVoxelsLookedAt` voxels.
std::vector<IsoSuggestion> suggest_iso_values(const Volume& volume, int count = 4);

}  // namespace edgesplat
