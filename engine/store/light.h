// Plans ambient occlusion and shadows: the light that reaches each splat.
#pragma once

#include <vector>

#include "engine/scene/scene.h"
#include "engine/volume/volume.h"

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

/// The matter of another volume, and where that lies.
struct MatterBeside {
    Matter matter;
    std::uint64_t checksum = 0;
    glm::ivec3 dims{0};
    glm::dmat3 axes{1};
    glm::dvec3 origin{0};
    MatterBeside(const Scene& scene, const Volume& volume);
    bool operator==(const MatterBeside&) const = default;
};

/// Plan of pass 2b.
struct OcclusionPlan {
    Matter matter;
    std::vector<MatterBeside> beside;
    double radius = 0;  ///< mm
    bool operator==(const OcclusionPlan&) const = default;
};

/// Plan of pass 2c.
struct ShadowPlan {
    Matter matter;
    std::vector<MatterBeside> beside;
    std::vector<Light> lights;  ///< lights with shadows; only kind and place or direction are set
    bool operator==(const ShadowPlan&) const = default;
};

/// `beside`: of the scene's other volumes.
OcclusionPlan plan_occlusion(const Scene& scene, std::vector<MatterBeside> beside);
ShadowPlan plan_shadows(const Scene& scene, std::vector<MatterBeside> beside);

}  // namespace edgesplat
