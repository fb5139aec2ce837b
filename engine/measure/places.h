// Places on surfaces, the distances and angles between them, and how well each is known.
#pragma once

#include <glm/glm.hpp>
#include <optional>
#include <span>
#include <vector>

#include "engine/measure/extents.h"
#include "engine/viewer/pick.h"

namespace edgesplat::measure {

/// Somewhere in the world.
struct Place {
    glm::dvec3 world{0};          ///< mm
    double uncertainty = 0;       ///< mm; 0 for a place that is no surface's
    std::optional<double> iso{};  ///< of the surface that it lies on
};

Place place_of(const viewer::Pick& pick);

/// The nearest place on a surface within `viewer::kCrossingReach` voxels of `world`, along the gradient; none where
/// there is none. `iso_values` ascend.
std::optional<Place> nearest_surface(const Volume& volume, std::span<const double> iso_values, const glm::dvec3& world);

/// mm; uncertain as both ends independently are.
Quantity distance(const Place& a, const Place& b);

/// At `corner`, between the ways to a and b, degrees; as uncertain as all three places independently make it. Throws
/// Error where one of the ways has no length.
Quantity angle(const Place& a, const Place& corner, const Place& b);

}  // namespace edgesplat::measure
