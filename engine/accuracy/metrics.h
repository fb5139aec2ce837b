// The figures of the accuracy report: of pictures, of profiles across an edge, of orbits, of repeated times.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "engine/image/image.h"

namespace edgesplat::accuracy {

/// How far a picture is from what it should be: colour channels, linear light, 1 = full scale.
struct ImageError {
    double rms = 0;
    double max = 0;  ///< infinite where a pixel is not a number
    bool operator==(const ImageError&) const = default;
};

/// The same as a peak signal-to-noise ratio, dB; infinite where there is no error.
double decibels(const ImageError& error);

/// Over the first three channels (or all where there are fewer). Throws Error when the sizes differ.
ImageError image_error(const Image& picture, const Image& expected);

/// Of several pictures of one size taken together; of none: 0.
ImageError pooled(std::span<const ImageError> errors);

/// What a profile across an edge came out as, in the unit of its positions.
struct ProfileEdge {
    double rise = 0;      ///< from 10 to 90 %
    double location = 0;  ///< of the 50 % crossing; positive: the solid is too large
};

/// Of a profile that falls from 1 (inside) to 0; sample i lies at first + i step, the true edge at 0. Nothing where it
/// does not cross 10, 50 and 90 %.
std::optional<ProfileEdge> profile_edge(std::span<const double> profile, double first, double step);

/// Frame-to-frame change over an orbit that the method has and its reference has not; colour channels, full scale = 1.
struct Popping {
    double mean_excess = 0, max_excess = 0;  ///< RMS of the method's change minus RMS of the reference's; can cancel
    double mean_difference = 0, max_difference = 0;  ///< RMS of (method's change - reference's change); cannot
};

/// Of at least two consecutive frames, as many of the one as of the other. Throws Error otherwise.
Popping popping(std::span<const Image> method, std::span<const Image> reference);

/// Value below which a share `q` (0..1) of the values lies, linear between them. NaN of none.
double quantile(std::vector<double> values, double q);

struct Spread {
    double median = 0, low = 0, high = 0;  ///< low, high: p10 and p90
};
Spread spread(const std::vector<double>& values);

struct CostAndError {
    double cost = 0, error = 0;
};

/// Indices of those that no other beats in both (equal pairs: the first), by rising cost. NaN is never on the front.
std::vector<std::size_t> pareto_front(std::span<const CostAndError> points);

}  // namespace edgesplat::accuracy
