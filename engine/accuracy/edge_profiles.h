// Measures how sharp the model's edges are and where they lie, along normals of a known surface, in the reconstruction
// of two-tone data: 1 in the inside material and 0 outside.
#pragma once

#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "engine/reference/reference_renderer.h"
#include "engine/volume/analytic_volumes.h"

namespace edgesplat::accuracy {

/// A point of a surface, in index space of the measured volume.
struct SurfacePoint {
    glm::dvec3 position{0};
    glm::dvec3 axis{0};  ///< out of the inside (values >= the iso-value); as long as the profile's unit of length
};

struct SurfacePoints {
    std::vector<SurfacePoint> points;
    double room = 3;      ///< voxels along the normal to both sides without a corner or other surface
    int near_border = 0;  ///< points left out within 3 voxels of the grid's border
    int disturbed = 0;    ///< points left out with a corner or other surface in that room
};

/// At most `count` random points of the surface, the same in every run; axes are unit normals. Needs
/// `scene.signed_distance`. If few points of a thin solid have 3 voxels of room, 2 or 1.5 are accepted.
SurfacePoints surface_points(const AnalyticScene& scene, int count);

/// Range and step of the samples of a profile, in the unit of its axis.
struct ProfileRange {
    double reach = 2.5;  ///< to both sides
    double step = 0.01;
};

/// Lengths in the unit of the axes, over all profiles that have an edge.
struct EdgeFigures {
    int measured = 0, missed = 0;  ///< missed: profiles that do not cross 10, 50 and 90 %
    double rise_mean = 0, rise_max = 0;
    double location_mean = 0, location_max = 0;  ///< of the magnitude
    double bias = 0;                             ///< mean with its sign; positive: the solid is too large
    bool operator==(const EdgeFigures&) const = default;
};

/// Figures of the first iso-value's surface in the model of `prepared`, over all points.
EdgeFigures edge_figures(const reference::PreparedVolume& prepared, std::span<const SurfacePoint> points,
                         const ProfileRange& range = {});

/// Figures of a trilinear ray caster: the interpolated field is inside from `iso` on, so its edges have no rise. Points
/// are in index space of the volume.
EdgeFigures ray_edge_figures(const Volume& volume, double iso, std::span<const SurfacePoint> points,
                             const ProfileRange& range = {});

}  // namespace edgesplat::accuracy
