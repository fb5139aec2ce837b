// What of the light reaches each splat, ambient occlusion and shadows, as it is planned.
#pragma once

#include <vector>

#include "engine/plan/plan.h"

namespace edgesplat {

/// What the light has to pass, as far as it can change without other splats being collected.
struct Matter {
    std::vector<double> extinction;       ///< of the materials, per mm
    std::vector<TransferPoint> transfer;  ///< colours do not count
    Clip clip;
    explicit Matter(const Scene& scene);
    bool operator==(const Matter&) const = default;
};

/// Pass 2b.
struct OcclusionPlan {
    Matter matter;
    double radius = 0;  ///< mm
    bool operator==(const OcclusionPlan&) const = default;
};

/// Passes 2c and 2d.
struct ShadowPlan {
    Matter matter;
    std::vector<Light> lights;  ///< those with shadows; only where they are counts
    ShadowQuality quality;
    Settings settings;  ///< as the lights' pictures are drawn
    bool operator==(const ShadowPlan&) const = default;
};

OcclusionPlan plan_occlusion(const Scene& scene);
ShadowPlan plan_shadows(const Scene& scene, const Settings& settings);

/// The pictures that a light takes of the box of the splats, each square: one, or for a light in or near the box the
/// sides of a cube around it that the box shows in. `reach`: of any kernel, voxels; `resolution`: pixels a side.
std::vector<Camera> light_views(const Light& light, const VolumeGeometry& geometry, const glm::ivec3& box_low,
                                const glm::ivec3& box_high, double reach, int resolution);

/// One of these pictures: optical depth, in sheets as thick as the number of layers asks for.
FramePlan plan_light_frame(const Volume& volume, const Scene& scene, const ShadowPlan& shadows, const Camera& view,
                           const SplatExtent& splats, double reach);

/// Device memory that a light's picture takes for its layers while it is swept, bytes.
std::uint64_t light_layer_bytes(const FramePlan& plan);

}  // namespace edgesplat
