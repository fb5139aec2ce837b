#include "engine/store/light.h"

#include <utility>

namespace edgesplat {

Matter::Matter(const Scene& scene) : iso_values(scene.iso_values), transfer(scene.transfer), clip(scene.effects.clip) {
    for (const Material& material : scene.materials)
        extinction.push_back(material.extinction);
    for (TransferPoint& point : transfer)
        point.color = {};
}

MatterBeside::MatterBeside(const Scene& scene, const Volume& volume)
    : matter(scene),
      checksum(volume.checksum),
      dims(volume.geometry.dims),
      axes(volume.geometry.index_to_world_axes),
      origin(volume.geometry.origin) {}

OcclusionPlan plan_occlusion(const Scene& scene, std::vector<MatterBeside> beside) {
    return {Matter(scene), std::move(beside), scene.effects.occlusion->radius};
}

ShadowPlan plan_shadows(const Scene& scene, std::vector<MatterBeside> beside) {
    ShadowPlan plan{Matter(scene), std::move(beside), {}};
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
