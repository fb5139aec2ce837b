// Pass 2b: how much of the ambient light reaches a splat (method.md, 2b_occlude_ambient).
#pragma once

#include "engine/reference/surface_point.h"

namespace edgesplat::reference {

constexpr int kOcclusionRays = 48, kOcclusionSteps = 256;

/// Share [0, 1] of the light from everywhere that reaches the record's splat within `radius` mm; `turned`: the other
/// face of a wall. `rays` other than what the device casts are for measuring its error.
double ambient_reach(const SplatRecord& record, const Field& field, const ScaledScene& scaled, const Scene& scene,
                     const VolumeGeometry& geometry, double band, double radius, bool turned = false,
                     int rays = kOcclusionRays);

}  // namespace edgesplat::reference
