// Finds where light arrives at a splat (docs/method/light.md), by engine/geometry/surface_point.glsl.
#pragma once

#include "engine/reference/2_collect_splats.h"
#include "engine/scene/clip_planes.h"
#include "shaders/shared/limits.h"

namespace edgesplat::reference {

/// Voxels between a surface and the point above it where light arrives: of lights with shadows, of ambient light.
constexpr double kShadowLift = static_cast<double>(shader::SHADOW_LIFT), kOcclusionLift = 1.25;

struct SurfacePoint {
    glm::dvec3 foot{0};    ///< relative to the voxel centre, index space
    glm::dvec3 normal{0};  ///< world, unit, outwards; 0: the splat has none
    glm::dvec3 step{0};    ///< one mm along the normal, index space
    double voxel = 1;      ///< mm per voxel along the normal
    double room = 0;       ///< mm along the normal before the next surface may follow
};

/// Whether the kernel also reaches a second face. `band`: R + a, voxels.
bool is_wall(const VoxelEdge& edge, double band);

/// The surface point of an edge. `turned`: the wall's other face.
SurfacePoint surface_point(const VoxelEdge& edge, double band, bool turned, const VolumeGeometry& geometry);

/// The same for a splat at x (index space). If a plane of `clip` is nearer to the voxel than the splat's own edge, the
/// surface is the cut.
SurfacePoint at_cut(const SurfacePoint& uncut, const VoxelEdge& edge, const glm::dvec3& x, const IndexClip& clip,
                    const VolumeGeometry& geometry);

}  // namespace edgesplat::reference
