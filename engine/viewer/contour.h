// Where rays cross iso-contours, and the uncertainty of the crossings.
#pragma once

#include <cmath>
#include <glm/glm.hpp>
#include <limits>
#include <optional>

#include "engine/viewer/samples.h"

namespace edgesplat::viewer {

inline constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// A ray in index space; t in mm from its origin.
struct IndexRay {
    glm::dvec3 origin, step;  ///< voxels; voxels per mm
    glm::dvec3 at(double t) const { return origin + t * step; }
};

/// The place between a and b where a function changes its sign, by bisection.
template <typename Function>
double bisected(const Function& f, double a, double b) {
    const bool positive = f(b) > 0;
    for (int i = 0; i < 60; ++i) {
        const double middle = (a + b) / 2;
        (f(middle) > 0) == positive ? b = middle : a = middle;
    }
    return (a + b) / 2;
}

inline constexpr int kCrossingReach = 2;

/// The place on a ray nearest to t, at most `kCrossingReach` voxels away, where `field` reaches `value`; nullopt if
/// none.
template <typename Field>
std::optional<double> crossing_near(const Field& field, const IndexRay& ray, double t, double value) {
    const double voxel = 1 / glm::length(ray.step), step = voxel / 4;
    const auto f = [&](double at) { return field(ray.at(at)) - value; };
    const double here = f(t);
    double before = here, after = here;
    for (int k = 1; k <= 4 * kCrossingReach; ++k) {
        const double back = f(t - k * step), on = f(t + k * step);
        const bool crossed_back = (back > 0) != (before > 0), crossed_on = (on > 0) != (after > 0);
        const double there = crossed_on ? bisected(f, t + (k - 1) * step, t + k * step) : kInfinity;
        const double behind = crossed_back ? bisected(f, t - k * step, t - (k - 1) * step) : kInfinity;
        if (crossed_on || crossed_back) return std::abs(there - t) < std::abs(behind - t) ? there : behind;
        before = back;
        after = on;
    }
    return std::nullopt;
}

/// Possible error of a contour's value at `voxel` that the samples cannot show, in the volume's unit: the larger of
/// half a step (of quantisation or binary data) and the effect of an edge sharper than the samples resolve, plus the
/// error of packing.
double value_uncertainty(const Samples& samples, const glm::dvec3& voxel);

/// Uncertainty, mm along the ray, of the place t where the trilinear values cross `value`: how far another
/// reconstruction or other rounding of the samples would move it.
double contour_uncertainty(const Samples& samples, const IndexRay& ray, double t, double value);

}  // namespace edgesplat::viewer
