// Plans ambient occlusion and shadows: the light that reaches each splat.
#pragma once

#include <vector>

#include "engine/plan/plan.h"

namespace edgesplat {

/// The matter that attenuates light: the part of a scene that can change without a new collection of splats.
struct Matter {
    std::vector<double> extinction;       ///< of each material, per mm
    std::vector<TransferPoint> transfer;  ///< colours are reset
    Clip clip;
    explicit Matter(const Scene& scene);
    bool operator==(const Matter&) const = default;
};

/// Plan of pass 2b.
struct OcclusionPlan {
    Matter matter;
    double radius = 0;  ///< mm
    bool operator==(const OcclusionPlan&) const = default;
};

/// Plan of passes 2c and 2d.
struct ShadowPlan {
    Matter matter;
    std::vector<Light> lights;  ///< lights with shadows; only kind and place or direction are set
    ShadowQuality quality;
    Settings settings;  ///< settings of the lights' pictures
    bool operator==(const ShadowPlan&) const = default;
};

OcclusionPlan plan_occlusion(const Scene& scene);
ShadowPlan plan_shadows(const Scene& scene, const Settings& settings);

/// Cameras of a light's pictures of the splats' box, all square: one camera; for a light in or near the box, one per
/// side of a cube around the light that shows the box. `reach`: the kernels' farthest reach, voxels. `resolution`:
/// pixels per side.
std::vector<Camera> light_views(const Light& light, const VolumeGeometry& geometry, const glm::ivec3& box_low,
                                const glm::ivec3& box_high, double reach, int resolution);

/// Plan of one of these pictures: optical depth, with a sheet thickness that gives at most `quality.layers` sheets.
FramePlan plan_light_frame(const Volume& volume, const Scene& scene, const ShadowPlan& shadows, const Camera& view,
                           const SplatExtent& splats, double reach);

/// Device memory of the layers of a light's picture while it is swept, bytes.
std::uint64_t light_layer_bytes(const FramePlan& plan);

}  // namespace edgesplat
