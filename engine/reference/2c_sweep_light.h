// Passes 2c and 2d, kernel by kernel instead of with pictures from the light: the optical depth from a light to the
// place where its light arrives at a splat (docs/method/light.md, 2d_shadow_splats).
#pragma once

#include <span>

#include "engine/reference/footprints.h"
#include "engine/reference/surface_point.h"

namespace edgesplat::reference {

/// Where light from direction `to_light` (world, unit) arrives at the splat, index space. `pixel`: size of a pixel of
/// the light's picture there, mm. `clip`: the scene's clip planes, index space.
glm::dvec3 lit_place(const SplatRecord& record, const Field& field, const VolumeGeometry& geometry, double band,
                     const glm::dvec3& to_light, double pixel, const IndexClip& clip = {});

/// exp(-tau) from the light to `place` (index space) through the kernels of `records`, as far as `clip` keeps them.
/// Directional and point lights.
double light_reach(std::span<const SplatRecord> records, const Field& field, const Scene& scene,
                   const VolumeGeometry& geometry, const Footprints& footprints, const Light& light,
                   const glm::dvec3& place, const IndexClip& clip = {});

}  // namespace edgesplat::reference
