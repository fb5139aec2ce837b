// Pass 2c: finds the share of a light that reaches a splat (docs/method/light.md, 2c_cast_shadows).
#pragma once

#include "engine/reference/2b_occlude_ambient.h"

namespace edgesplat::reference {

/// The surface point of a splat for light from `light`: of a wall, the face that the light sees. `clip`: the scene's
/// clip planes, index space.
SurfacePoint lit_point(const SplatRecord& record, const Field& field, const VolumeGeometry& geometry, double band,
                       const Light& light, const IndexClip& clip = {});

/// Share [0, 1] of a directional or point light that passes the matter to the surface point of a voxel in `own`.
double light_reach(const SurfacePoint& point, const glm::ivec3& voxel, const VolumeGeometry& own,
                   const LightMatter& matter, const Light& light);

}  // namespace edgesplat::reference
