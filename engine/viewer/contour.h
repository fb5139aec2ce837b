// Where lines cross iso-contours, and how well samples tell the place.
#pragma once

#include <glm/glm.hpp>
#include <limits>

#include "engine/viewer/samples.h"

namespace edgesplat::viewer {

inline constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// A ray in index space; t in mm from its origin.
struct IndexRay {
    glm::dvec3 origin, step;  ///< voxels; voxels per mm
    glm::dvec3 at(double t) const { return origin + t * step; }
};

/// Where a function that changes its sign between a and b does so.
template <typename Function>
double bisected(const Function& f, double a, double b) {
    const bool positive = f(b) > 0;
    for (int i = 0; i < 60; ++i) {
        const double middle = (a + b) / 2;
        (f(middle) > 0) == positive ? b = middle : a = middle;
    }
    return (a + b) / 2;
}

/// By how much the value of a contour at `voxel` may be wrong without the samples showing it: half a step of
/// quantisation, or of data that say yes or no; what an edge sharper than samples can show leaves open; and what
/// packing lost. In the volume's unit.
double value_uncertainty(const Samples& samples, const glm::dvec3& voxel);

/// How far along the ray another reconstruction or other rounding of the samples would put the place at t where the
/// trilinear values cross `value`, mm.
double contour_uncertainty(const Samples& samples, const IndexRay& ray, double t, double value);

}  // namespace edgesplat::viewer
