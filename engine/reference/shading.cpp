#include "engine/reference/shading.h"

#include "engine/geometry/in_double.h"

namespace edgesplat::geometry {
namespace {

/// The lights and effects of a scene, seen from the eye.
struct SceneShading {
    SceneShading(const Scene& of, const vec3& from)
        : scene(of),
          eye(from),
          LIGHTS(static_cast<uint>(of.lights.size())),
          SILHOUETTE(of.effects.silhouette ? 1 : 0),
          FOG(of.effects.fog ? 1 : 0) {}

    const Scene& scene;
    vec3 eye;
    uint LIGHTS, SILHOUETTE, FOG;
    static constexpr uint GLOSS = 1;

    using LightShares = std::array<double, kMaxLights>;
    static Real light_share(const LightShares& shares, uint light) { return shares[light]; }
    vec4 light_place(uint number) const {
        const Light& light = scene.lights[number];
        switch (light.kind) {
            case Light::Kind::Headlight:
                break;
            case Light::Kind::Directional:
                return {unit(light.direction), 0};
            case Light::Kind::Point:
                return {light.position - eye, 1};
        }
        return {0, 0, 0, 1};
    }
    vec3 light_sent(uint light) const { return scene.lights[light].intensity * scene.lights[light].color; }
    Real ambient_light() const { return scene.ambient; }
    vec4 silhouette_color() const { return {scene.effects.silhouette->color, scene.effects.silhouette->strength}; }
    Real silhouette_sharpness() const { return scene.effects.silhouette->sharpness; }
    vec4 fog_color() const { return {scene.effects.fog->color, scene.effects.fog->density}; }
    Real fog_start() const { return scene.effects.fog->start; }

#include "engine/geometry/shading.glsl"

    Surface surface(const reference::Surface& seen, const reference::Reach& reach) const {
        const LightResponse& response = seen.response;
        const vec3 from_eye = seen.position - eye;
        return {seen.color,   {response.ambient, response.diffuse, response.specular, response.shininess},
                reach.lights, seen.normal != vec3(0),
                seen.normal,  reach.ambient,
                from_eye,     from_eye == vec3(0) ? vec3(0) : -normalize(from_eye),
                seen.depth};
    }
};

}  // namespace
}  // namespace edgesplat::geometry

namespace edgesplat::reference {

glm::dvec3 lit(const Scene& scene, const Surface& surface, const glm::dvec3& eye, const Reach& reach) {
    if (scene.lights.empty()) return surface.color;
    geometry::SceneShading shading(scene, eye);
    return shading.lit(shading.surface(surface, reach));
}

glm::dvec3 shade(const Scene& scene, const Surface& surface, const glm::dvec3& eye, const Reach& reach) {
    geometry::SceneShading shading(scene, eye);
    return shading.shade(shading.surface(surface, reach));
}

}  // namespace edgesplat::reference
