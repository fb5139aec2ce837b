#include "engine/store/light.h"

namespace edgesplat {

Matter::Matter(const Scene& scene) : iso_values(scene.iso_values), transfer(scene.transfer), clip(scene.effects.clip) {
    for (const Material& material : scene.materials)
        extinction.push_back(material.extinction);
    for (TransferPoint& point : transfer)
        point.color = {};
}

OcclusionPlan plan_occlusion(const Scene& scene) {
    return {Matter(scene), scene.effects.occlusion->radius};
}

ShadowPlan plan_shadows(const Scene& scene) {
    ShadowPlan plan{Matter(scene), {}};
    for (const std::size_t i : shadow_lights(scene)) {
        const Light& light = scene.lights[i];
        const bool far = light.kind == Light::Kind::Directional;
        plan.lights.push_back({.kind = light.kind,
                               .direction = far ? light.direction : Light{}.direction,
                               .position = far ? Light{}.position : light.position});
    }
    return plan;
}

}  // namespace edgesplat
