// Preprocessing of volumes, and statistics for the choice of iso-values.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "engine/volume/volume.h"
#include "engine/volume/voxel_box.h"

namespace edgesplat {

/// Mean over 3x3x3 voxels (clamped at the border); the paper applies it to binary data. Samples without data count in
/// no mean and stay without. Keeps geometry, name, notes and shown labels; the result is finished.
Volume box_filter(const Volume& volume);

/// 1 where the sample is >= `iso_value`, else 0; samples without data stay without. Keeps geometry, name and notes; the
/// result is finished.
Volume threshold(const Volume& volume, double iso_value);

/// The box of voxels from low to high, both included; world positions do not change. Throws Error unless the box lies
/// in the volume and has at least 2 voxels along each axis.
Volume cropped(const Volume& volume, const glm::ivec3& low, const glm::ivec3& high);

/// The scaled field of a sample without data. All others are >= 0, so its sign tells it apart; to interpolation it is
/// 0.
inline constexpr float kScaledNoData = -1e-30F;

/// The scaled field of docs/method.md: F = (f - f_min) / (f_max - f_min) computed in double, stored as float; 0 if the
/// volume is constant; kScaledNoData without data. Same order as `Volume::values`.
std::vector<float> scaled_field(const Volume& volume);
/// The scaled field of a box of the volume.
std::vector<float> scaled_box(const Volume& volume, const VoxelBox& box);
/// The same scaling of one value, e.g. of a transfer point; the result may lie outside [0, 1]. 0 if the volume is
/// constant.
inline double scaled_value(const Volume& volume, double value) {
    const double low = static_cast<double>(volume.min_value), range = static_cast<double>(volume.max_value) - low;
    return range > 0 ? (value - low) / range : 0.0;
}
/// The scaled field of one sample; NaN: without data.
inline float scaled_sample(const Volume& volume, float value) {
    if (std::isnan(value)) return kScaledNoData;
    // Rounding in a packed file may leave the range.
    return std::max(static_cast<float>(scaled_value(volume, static_cast<double>(value))), 0.0F);
}

/// The scaled field at the volume's border, half a voxel beyond an outermost sample `here`: linear from the sample
/// before it.
inline float scaled_at_border(float here, float before) {
    return std::max(1.5F * here - 0.5F * before, 0.0F);
}

/// The same scaling of an iso-value. +-1e9 if all samples lie on one side of it, so that no edge estimator extrapolates
/// to it.
double scaled_iso_value(const Volume& volume, double iso_value);

/// Coefficients of the cubic B-spline that interpolates `field` (x fastest), with zero second derivative at the
/// borders. The `cubic` edge estimator uses them. Same size and order as `field`. Throws Error if dims and field
/// disagree.
std::vector<float> bspline_coefficients(const std::vector<float>& field, const glm::ivec3& dims);

/// Indices of the four coefficients around a position of that spline on one axis, with their weights for the value and
/// the slope at the nearest place between the outermost samples.
struct SplineTaps {
    std::array<double, 4> weights{}, slopes{};
    std::array<int, 4> places{};  ///< index of each coefficient; those beyond a border have weight 0
};
/// `place` may be any number. size >= 1.
SplineTaps spline_taps(double place, int size);
/// Slope, per step along each axis, and value (w) of the spline with these coefficients at the nearest place between
/// the outermost samples.
glm::dvec4 spline_at(const std::vector<float>& coefficients, const glm::ivec3& dims, const glm::dvec3& place);

/// Mean of the samples with data; 0 if there are none. Of a packed volume as its file states it.
double mean_of(const Volume& volume);

/// CRC-32 of zlib over the samples as little-endian float32 in the file's unit, x fastest; NaN (0x7fc00000) without
/// data. Of labels that floats cannot tell apart: over their numbers as 64-bit integers, -2^63 without data. For
/// comparison with other programs. Throws Error for a packed volume.
std::uint32_t samples_crc32(const Volume& volume);

struct Histogram {
    /// value range; bin i covers low + [i, i+1) * (high - low) / bins, the last bin is closed
    double low = 0, high = 0;
    std::vector<std::size_t> counts;
    double center(std::size_t bin) const {
        return low + (static_cast<double>(bin) + 0.5) * (high - low) / static_cast<double>(counts.size());
    }
};

/// Counts all samples with data in `bins` >= 1 equal bins from the smallest to the largest one. All samples of a
/// constant volume are in bin 0. For a packed volume, the bins of its file are added up: exact if their number is a
/// multiple of `bins`.
Histogram histogram(const Volume& volume, int bins);

struct IsoSuggestion {
    double value = 0;     ///< in the volume's unit
    double strength = 0;  ///< visibility x steepness x smoothness, relative to the strongest, (0, 1]
};

/// Suggests iso-values of surfaces. Rays along the axes find the surfaces that are met first from outside. The score of
/// a value is the share of rays that meet its surface, times its mean gradient magnitude, times the sixth power of how
/// well the gradients on both sides agree in direction. The suggestions are the peaks of the score over the values.
/// Padding around a measured cylinder counts as no surface. With few distinct values (masks, labels), suggestions lie
/// halfway between neighbouring values. Strongest first, at most `count`; empty for a constant volume. Packed volumes
/// are analysed at their finest level of at most `kMaxVoxelsAnalysed` voxels.
std::vector<IsoSuggestion> suggest_iso_values(const Volume& volume, int count = 4);

}  // namespace edgesplat
