// How sharp the model's edges are and whether they are in the right place: the reconstruction of two-tone data, 1 in
// the inside material and 0 outside, along normals of a surface that is known.
#pragma once

#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "engine/reference/reference_renderer.h"
#include "engine/volume/analytic_volumes.h"

namespace edgesplat::accuracy {

/// A place on a surface, in index space of the volume that is judged.
struct SurfacePoint {
    glm::dvec3 position{0};
    glm::dvec3 axis{0};  ///< out of the inside (values >= the iso-value); as long as the profile's unit of length
};

struct SurfacePoints {
    std::vector<SurfacePoint> points;
    double room = 3;      ///< voxels along the normal to both sides that no corner or other surface is in
    int near_border = 0;  ///< found, but left out: within 3 voxels of the grid's border
    int disturbed = 0;    ///< found, but left out: something else is in that room
};

/// At most `count` points, spread over the surface at random, always the same ones; axes are unit normals. Needs
/// `scene.signed_distance`. Where a solid is so thin that few points have 3 voxels of room, 2 or 1.5 must do.
SurfacePoints surface_points(const AnalyticScene& scene, int count);

/// Where profiles are sampled, in the unit of their axes.
struct ProfileRange {
    double reach = 2.5;  ///< to both sides
    double step = 0.01;
};

/// Lengths in the unit of the axes, over all profiles that have an edge.
struct EdgeFigures {
    int measured = 0, missed = 0;  ///< missed: the profile does not cross 10, 50 and 90 %
    double rise_mean = 0, rise_max = 0;
    double location_mean = 0, location_max = 0;  ///< of the magnitude
    double bias = 0;                             ///< mean with its sign; positive: the solid is too large
    bool operator==(const EdgeFigures&) const = default;
};

/// Of the surface of the first iso-value in the model of `prepared`, over all points.
EdgeFigures edge_figures(const reference::PreparedVolume& prepared, std::span<const SurfacePoint> points,
                         const ProfileRange& range = {});

/// The same of what a trilinear ray caster shows: the interpolated field from `iso` on, whose edges have no rise.
/// Points are in index space of the volume.
EdgeFigures ray_edge_figures(const Volume& volume, double iso, std::span<const SurfacePoint> points,
                             const ProfileRange& range = {});

}  // namespace edgesplat::accuracy
