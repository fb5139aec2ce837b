// Plans ambient occlusion and shadows: the light that reaches each splat.
#pragma once

#include <vector>

#include "engine/scene/scene.h"

namespace edgesplat {

/// The matter that attenuates light: the part of a scene that can change without a new collection of splats.
struct Matter {
    std::vector<double> iso_values;
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

/// Plan of pass 2c.
struct ShadowPlan {
    Matter matter;
    std::vector<Light> lights;  ///< lights with shadows; only kind and place or direction are set
    bool operator==(const ShadowPlan&) const = default;
};

OcclusionPlan plan_occlusion(const Scene& scene);
ShadowPlan plan_shadows(const Scene& scene);

}  // namespace edgesplat
