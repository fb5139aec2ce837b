// Points on surfaces, distances and angles between them, and their uncertainties.
#pragma once

#include <glm/glm.hpp>
#include <optional>
#include <span>
#include <vector>

#include "engine/measure/extents.h"
#include "engine/viewer/pick.h"

namespace edgesplat::measure {

/// A point in the world.
struct Place {
    glm::dvec3 world{0};          ///< mm
    double uncertainty = 0;       ///< mm; 0 for a point that lies on no surface
    std::optional<double> iso{};  ///< iso-value of its surface
};

Place place_of(const viewer::Pick& pick);

/// The nearest point on a surface along the gradient, within `viewer::kCrossingReach` voxels of `world`; none if there
/// is none. `iso_values` ascend.
std::optional<Place> nearest_surface(const Volume& volume, std::span<const double> iso_values, const glm::dvec3& world);

/// Distance in mm; the uncertainties of both ends are independent.
Quantity distance(const Place& a, const Place& b);

/// Angle at `corner` between the directions to a and b, degrees; the uncertainties of the three points are independent.
/// Throws Error if a or b coincides with `corner`.
Quantity angle(const Place& a, const Place& corner, const Place& b);

}  // namespace edgesplat::measure
