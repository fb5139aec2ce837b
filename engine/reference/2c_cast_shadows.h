// Pass 2c: finds the share of a light that reaches a splat (docs/method/light.md, 2c_cast_shadows).
#pragma once

#include "engine/reference/surface_point.h"

namespace edgesplat::reference {

/// The surface point of a splat for light from `light`: of a wall, the face that the light sees. `clip`: the scene's
/// clip planes, index space.
SurfacePoint lit_point(const SplatRecord& record, const Field& field, const VolumeGeometry& geometry, double band,
                       const Light& light, const IndexClip& clip = {});

/// Share [0, 1] of a directional or point light that reaches the surface point of a voxel.
double light_reach(const SurfacePoint& point, std::uint32_t voxel, const Field& field, const ScaledScene& scaled,
                   const Scene& scene, const VolumeGeometry& geometry, const Light& light);

}  // namespace edgesplat::reference
