// Building blocks of the builtin scenes; internal to analytic_*.cpp.
#pragma once

#include <cmath>
#include <functional>
#include <string>

#include "engine/volume/analytic_volumes.h"

namespace edgesplat::analytic {

constexpr double kPi = 3.14159265358979323846;
constexpr double kSqrt2 = 1.41421356237309504880;

/// Signed distance to a surface (voxels, negative inside) and its gradient, of unit length almost everywhere.
struct Distance {
    double value;
    glm::dvec3 gradient;
};
using DistanceFunction = std::function<Distance(const glm::dvec3&)>;

/// Distances to solids at the origin: a ball, a torus around the z axis, and a box of half sides `half` with edges
/// rounded to radius `rounding`.
Distance ball_distance(const glm::dvec3& p, double radius);
Distance ring_distance(const glm::dvec3& p, double major_radius, double minor_radius);
Distance box_distance(const glm::dvec3& p, const glm::dvec3& half, double rounding);

/// Integral of a Gaussian of standard deviation `sd` from -infinity to t, and the integrand at t.
inline double step(double t, double sd) {
    return 0.5 * std::erfc(-t / (kSqrt2 * sd));
}
inline double bell(double t, double sd) {
    return std::exp(-0.5 * t * t / (sd * sd)) / (sd * std::sqrt(2 * kPi));
}

/// Throws Error unless inside > outside, and blur > 0 or the profile is binary.
void check(const EdgeProfile& profile);

/// A scene with one surface: maps its signed distance through the profile. Throws Error like `check`.
AnalyticScene solid(std::string name, const glm::ivec3& dims, const EdgeProfile& profile, DistanceFunction distance);

/// v / |v|. Throws Error naming `what` if v has no direction.
glm::dvec3 unit(const glm::dvec3& v, const char* what);

/// Centre of the grid, index space.
inline glm::dvec3 middle(const glm::ivec3& dims) {
    return (glm::dvec3(dims) - 1.0) * 0.5;
}

/// Plane walls of different thickness; the Marschner-Lobb test signal; an electron density; a head.
AnalyticScene plates();
AnalyticScene marschner_lobb();
AnalyticScene orbital();
AnalyticScene phantom();

/// Solids in grids of 40^3 voxels, rotated away from the grid axes (docs/method.md, Builtin scenes).
AnalyticScene ellipsoid();
AnalyticScene box(std::string name, double rounding);  ///< `rounding`: radius of the edges, voxels; 0: sharp
AnalyticScene tilted_torus();
AnalyticScene tube();
AnalyticScene shell();
AnalyticScene balls();
AnalyticScene gyroid();
AnalyticScene ball(std::string name, double radius, bool binary);
AnalyticScene vessels();
AnalyticScene specks();

}  // namespace edgesplat::analytic
