// Pass 2b: finds the share of the ambient light that reaches a splat (docs/method/light.md, 2b_occlude_ambient).
#pragma once

#include "engine/reference/surface_point.h"

namespace edgesplat::reference {

constexpr int kOcclusionRays = 48, kOcclusionSteps = 256;
/// Optical depth beyond which nothing is seen.
constexpr double kDark = 12;

/// Extinction of matter with the scaled value, per mm.
double extinction_of(double value, const ScaledScene& scaled, const Scene& scene);

/// Share [0, 1] of the ambient light that reaches the splat; occluders further away than `radius` mm do not count.
/// `turned`: the other face of a wall. The device casts kOcclusionRays rays; other numbers serve to measure its error.
double ambient_reach(const SplatRecord& record, const Field& field, const ScaledScene& scaled, const Scene& scene,
                     const VolumeGeometry& geometry, double band, double radius, bool turned = false,
                     int rays = kOcclusionRays);

/// Matter that attenuates light, of the splats' own volume or of another one.
struct LightMatter {
    Field field;
    const ScaledScene& scaled;
    const Scene& scene;
    const VolumeGeometry& geometry;
};

/// The same at a point beside the face of a voxel in `own`.
double ambient_reach_at(const SurfacePoint& point, const glm::ivec3& voxel, const VolumeGeometry& own,
                        const LightMatter& matter, double radius, int rays = kOcclusionRays);

}  // namespace edgesplat::reference
