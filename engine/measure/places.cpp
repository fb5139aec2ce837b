#include "engine/measure/places.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "engine/error.h"
#include "engine/viewer/contour.h"

namespace edgesplat::measure {
namespace {

/// The line through a point along the gradient; none if the gradient is 0.
std::optional<viewer::IndexRay> steepest_line(const VolumeGeometry& geometry, const viewer::Samples& samples,
                                              const glm::dvec3& voxel) {
    const glm::dmat3 to_index = glm::inverse(geometry.index_to_world_axes);
    const glm::dvec3 normal = glm::transpose(to_index) * samples.gradient(voxel);
    const double length = glm::length(normal);
    if (!(length > 0) || !std::isfinite(length)) return std::nullopt;
    return viewer::IndexRay{voxel, to_index * (normal / length)};
}

}  // namespace

Place place_of(const viewer::Pick& pick) {
    return {pick.world, pick.uncertainty, pick.value};
}

std::optional<Place> nearest_surface(const Volume& volume, std::span<const double> iso_values,
                                     const glm::dvec3& world) {
    const VolumeGeometry& geometry = volume.geometry;
    const viewer::Samples samples(volume);
    const auto field = [&](const glm::dvec3& p) { return samples.linear(p); };
    std::optional<Place> nearest;
    for (const double iso : iso_values) {
        glm::dvec3 voxel = geometry.to_index(world);
        std::optional<viewer::IndexRay> line;
        std::optional<double> t;
        // The gradient at the surface gives a straighter line to the point than the gradient at the point.
        for (int round = 0; round < 2; ++round) {
            line = steepest_line(geometry, samples, voxel);
            if (!line) break;
            line->origin = geometry.to_index(world);
            t = crossing_near(field, *line, 0, iso);
            if (!t) break;
            voxel = line->at(*t);
        }
        if (!t) continue;
        const glm::dvec3 found = geometry.to_world(voxel);
        if (nearest && glm::distance(nearest->world, world) <= glm::distance(found, world)) continue;
        nearest = Place{found, contour_uncertainty(samples, *line, *t, iso), iso};
    }
    return nearest;
}

Quantity distance(const Place& a, const Place& b) {
    return {glm::distance(a.world, b.world), std::hypot(a.uncertainty, b.uncertainty)};
}

Quantity angle(const Place& a, const Place& corner, const Place& b) {
    const glm::dvec3 to_a = a.world - corner.world, to_b = b.world - corner.world;
    const double la = glm::length(to_a), lb = glm::length(to_b);
    if (!(la > 0) || !(lb > 0)) fail("angle: two of its three points are equal");
    const double radians = std::atan2(glm::length(glm::cross(to_a, to_b)), glm::dot(to_a, to_b));
    // Errors of an end perpendicular to its direction turn the angle by error / length; an error of the corner turns
    // both directions.
    const double turn = std::hypot(a.uncertainty / la, b.uncertainty / lb,
                                   corner.uncertainty * glm::length(to_a / (la * la) - to_b / (lb * lb)));
    return {glm::degrees(radians), glm::degrees(std::min(turn, std::numbers::pi))};
}

}  // namespace edgesplat::measure
