// The quantities of the accuracy report: errors of pictures, edges of profiles, popping on orbits, spread of times.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "engine/image/image.h"

namespace edgesplat::accuracy {

/// Error of a picture against the expected one: colour channels, linear light, 1 = full scale.
struct ImageError {
    double rms = 0;
    double max = 0;  ///< infinite if a pixel is NaN
    bool operator==(const ImageError&) const = default;
};

/// The peak signal-to-noise ratio of the RMS, dB; infinite without an error.
double decibels(const ImageError& error);

/// Error over the first three channels (or all, if there are fewer). Throws Error if the sizes differ.
ImageError image_error(const Image& picture, const Image& expected);

/// The common error of several pictures of one size; 0 without pictures.
ImageError pooled(std::span<const ImageError> errors);

/// The edge that a profile shows, in the unit of the profile's positions.
struct ProfileEdge {
    double rise = 0;      ///< from 10 to 90 %
    double location = 0;  ///< position of the 50 % crossing; positive: the solid is too large
};

/// The edge of a profile that falls from 1 (inside) to 0. Sample i lies at first + i step; the true edge is at 0.
/// nullopt unless the profile crosses 10, 50 and 90 %.
std::optional<ProfileEdge> profile_edge(std::span<const double> profile, double first, double step);

/// Frame-to-frame change over an orbit that the method has and its reference does not; colour channels, full scale = 1.
struct Popping {
    double mean_excess = 0, max_excess = 0;  ///< RMS of the method's change minus RMS of the reference's; can cancel
    double mean_difference = 0, max_difference = 0;  ///< RMS of (method's change - reference's change); nothing cancels
};

/// Popping of at least two consecutive frames and as many of the reference. Throws Error otherwise.
Popping popping(std::span<const Image> method, std::span<const Image> reference);

/// The value below which a share `q` (0..1) of the values lies, interpolated linearly. NaN without values.
double quantile(std::vector<double> values, double q);

struct Spread {
    double median = 0, low = 0, high = 0;  ///< low, high: p10 and p90
};
Spread spread(const std::vector<double>& values);

struct CostAndError {
    double cost = 0, error = 0;
};

/// Indices of the points that no other point beats in both (the first of equal ones), by rising cost. NaN is never
/// among them.
std::vector<std::size_t> pareto_front(std::span<const CostAndError> points);

}  // namespace edgesplat::accuracy
