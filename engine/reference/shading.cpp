#include "engine/reference/shading.h"

#include <algorithm>
#include <cmath>

namespace edgesplat::reference {

namespace {

glm::dvec3 unit_or_zero(const glm::dvec3& v) {
    return v == glm::dvec3(0) ? v : unit(v);
}

/// Unit vector from `position` to the light; 0 at the light itself.
glm::dvec3 towards(const Light& light, const glm::dvec3& position, const glm::dvec3& eye) {
    switch (light.kind) {
        case Light::Kind::Headlight:
            break;
        case Light::Kind::Directional:
            return unit(light.direction);
        case Light::Kind::Point:
            return unit_or_zero(light.position - position);
    }
    return unit_or_zero(eye - position);
}

}  // namespace

glm::dvec3 lit(const Scene& scene, const Surface& surface, const glm::dvec3& eye, const Reach& reach) {
    if (scene.lights.empty()) return surface.color;
    const LightResponse& response = surface.response;
    const bool has_normal = surface.normal != glm::dvec3(0);
    const glm::dvec3 to_eye = unit_or_zero(eye - surface.position);
    glm::dvec3 diffuse(scene.ambient * response.ambient * reach.ambient);
    glm::dvec3 specular(0);
    for (std::size_t l = 0; l < scene.lights.size(); ++l) {
        const Light& light = scene.lights[l];
        const glm::dvec3 sent = light.intensity * light.color * reach.lights[l];
        const glm::dvec3 to_light = towards(light, surface.position, eye);
        // At the light itself, light falls along the normal.
        const double facing = to_light == glm::dvec3(0) ? 1.0 : glm::dot(surface.normal, to_light);
        diffuse += response.diffuse * sent * (has_normal ? std::max(facing, 0.0) : 0.5);
        if (!has_normal || !(facing > 0)) continue;
        const double along = std::max(glm::dot(surface.normal, unit_or_zero(to_light + to_eye)), 0.0);
        specular += response.specular * sent * std::pow(along, response.shininess);
    }
    return surface.color * diffuse + specular;
}

glm::dvec3 shade(const Scene& scene, const Surface& surface, const glm::dvec3& eye, const Reach& reach) {
    glm::dvec3 color = lit(scene, surface, eye, reach);
    if (const auto& silhouette = scene.effects.silhouette; silhouette && surface.normal != glm::dvec3(0)) {
        const double facing = std::abs(glm::dot(surface.normal, unit_or_zero(eye - surface.position)));
        const double share = silhouette->strength * std::pow(std::max(1 - facing, 0.0), silhouette->sharpness);
        color = glm::mix(color, silhouette->color, share);
    }
    if (const auto& fog = scene.effects.fog) {
        const double clear = std::exp(-fog->density * std::max(surface.depth - fog->start, 0.0));
        color = glm::mix(fog->color, color, clear);
    }
    return color;
}

}  // namespace edgesplat::reference
