// Where light arrives at a splat (method.md, Light that arrives). Mirrors shaders/light/surface_point.glsl.
#pragma once

#include "engine/reference/2_collect_splats.h"
#include "engine/scene/clip_planes.h"

namespace edgesplat::reference {

/// Voxels between a surface and the place that looks up from it, for shadows at least and for ambient light.
constexpr double kShortestLift = 1.5, kLongestLift = 8, kOcclusionLift = 1.25;

struct SurfacePoint {
    glm::dvec3 foot{0};    ///< relative to the voxel centre, index space
    glm::dvec3 normal{0};  ///< world, unit, outwards; 0 where the splat has none
    glm::dvec3 step{0};    ///< index space: one mm along the normal
    double voxel = 1;      ///< mm per voxel along the normal
    double room = 0;       ///< mm along the normal to where the next surface may be
};

/// Whether the kernel reaches a second face too. `band`: R + a, voxels.
bool is_wall(const VoxelEdge& edge, double band);

/// `turned`: of a wall, the face on the other side.
SurfacePoint surface_point(const VoxelEdge& edge, double band, bool turned, const VolumeGeometry& geometry);

/// The same of a splat at x (index space) whose kernel `clip` cuts: where a plane is nearer to the voxel than the
/// splat's own edge, the cut is the surface.
SurfacePoint at_cut(const SurfacePoint& uncut, const VoxelEdge& edge, const glm::dvec3& x, const IndexClip& clip,
                    const VolumeGeometry& geometry);

}  // namespace edgesplat::reference
