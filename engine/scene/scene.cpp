#include "engine/scene/scene.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "engine/scene/checks.h"
#include "engine/volume/volume.h"

namespace edgesplat {

namespace {

void check_share(const std::string& field, double value) {
    if (!(value >= 0) || !std::isfinite(value)) fail("scene {}: {} is not a finite number >= 0", field, value);
}

void check_materials(const Scene& scene) {
    const std::size_t count = scene.iso_values.size();
    if (scene.materials.size() != count + 1) {
        fail("scene materials: {} materials, expected {} (one more than iso-values)", scene.materials.size(),
             count + 1);
    }
    for (std::size_t m = 0; m < scene.materials.size(); ++m) {
        const auto& [color, extinction, response, name] = scene.materials[m];
        const std::string field = fmt::format("materials[{}].", m);
        check_color(field + "color", color);
        if (!(extinction >= 0) || !std::isfinite(extinction)) {
            fail("scene {}extinction: {} is not a finite number >= 0 (per mm)", field, extinction);
        }
        check_share(field + "response.ambient", response.ambient);
        check_share(field + "response.diffuse", response.diffuse);
        check_share(field + "response.specular", response.specular);
        if (!(response.shininess >= 1 && response.shininess <= 1000)) {
            fail("scene {}response.shininess: {} is outside [1, 1000]", field, response.shininess);
        }
    }
}

void check_transfer(const std::vector<TransferPoint>& points) {
    if (points.size() > kMaxTransferPoints) {
        fail("scene transfer: {} points, expected at most {}", points.size(), kMaxTransferPoints);
    }
    for (std::size_t i = 0; i < points.size(); ++i) {
        const auto& [value, color, extinction] = points[i];
        if (!std::isfinite(value)) fail("scene transfer[{}].value: {} is not finite", i, value);
        if (i > 0 && !(value > points[i - 1].value)) {
            fail("scene transfer[{}].value: {} is not above the one before ({})", i, value, points[i - 1].value);
        }
        check_color(fmt::format("transfer[{}].color", i), color);
        if (!(extinction >= 0) || !std::isfinite(extinction)) {
            fail("scene transfer[{}].extinction: {} is not a finite number >= 0 (per mm)", i, extinction);
        }
    }
}

void check_lights(const std::vector<Light>& lights) {
    if (lights.size() > kMaxLights) fail("scene lights: {} lights, expected at most {}", lights.size(), kMaxLights);
    std::size_t with_shadows = 0;
    for (std::size_t i = 0; i < lights.size(); ++i) {
        const Light& light = lights[i];
        const std::string field = fmt::format("lights[{}].", i);
        check_color(field + "color", light.color);
        check_share(field + "intensity", light.intensity);
        const glm::dvec3 &d = light.direction, &p = light.position;
        const double length = glm::length(d);
        if (light.kind == Light::Kind::Directional && (!(length > 0) || !std::isfinite(length))) {
            fail("scene {}direction: ({}, {}, {}) is not a finite vector other than 0", field, d.x, d.y, d.z);
        }
        if (light.kind == Light::Kind::Point && !std::isfinite(glm::dot(p, p))) {
            fail("scene {}position: ({}, {}, {}) is not finite", field, p.x, p.y, p.z);
        }
        if (light.shadows && light.kind == Light::Kind::Headlight) {
            fail("scene {}shadows: a headlight casts no visible shadows; expected a directional or point light", field);
        }
        with_shadows += light.shadows ? 1 : 0;
    }
    if (with_shadows > kMaxShadowLights) {
        fail("scene lights: {} lights with shadows, expected at most {}", with_shadows, kMaxShadowLights);
    }
}

}  // namespace

glm::dvec3 unit(const glm::dvec3& v) {
    const glm::dvec3 scaled = v / std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)});
    return scaled / glm::length(scaled);
}

bool lights_edges_only(const Scene& scene, bool edges_drawn) {
    return scene.lit == Lit::Edges && edges_drawn && !scene.iso_values.empty();
}

Light directional_light(const glm::dvec3& towards) {
    Light light;
    light.kind = Light::Kind::Directional;
    light.direction = towards;
    return light;
}

std::string raycast_obstacle(const Scene& scene) {
    const Effects& effects = scene.effects;
    if (!scene.added.empty()) return "several volumes";
    if (scene.lights.size() > 1) return "more than one light";
    for (const Light& light : scene.lights) {
        if (light.kind == Light::Kind::Point) return "a point light";
        if (light.shadows) return "shadows";
        if (light.color != glm::dvec3(1)) return "a coloured light";
    }
    for (const Material& material : scene.materials)
        if (material.response != LightResponse{}) return "a material's own response to light";
    if (scene.lit != Lit::Everywhere) return "light on edges only";
    if (effects.fog) return "fog";
    if (effects.silhouette) return "silhouettes";
    if (effects.occlusion) return "ambient occlusion";
    if (!effects.clip.empty()) return "clip planes";
    if (effects.background_top) return "a background of two colours";
    if (effects.antialias) return "antialiased footprints";
    if (effects.samples != 1) return "several samples a pixel";
    return "";
}

Scene scene_of_volume(const Scene& scene, std::size_t number) {
    Scene one = scene;
    one.added.clear();
    if (number > 0) {
        const AddedVolume& added = scene.added[number - 1];
        one.iso_values = added.iso_values;
        one.materials = added.materials;
        one.transfer = added.transfer;
        one.label_colors = added.label_colors;
        one.clipped = added.clipped;
    }
    if (!one.clipped) one.effects.clip = {};
    one.clipped = true;
    for (std::size_t i = 0; i < scene.added.size(); ++i) {
        if (i + 1 == number || !scene.added[i].replaces) continue;
        if (!one.effects.clip.remove.empty())
            fail("volumes[{}]: replaces the others within its grid, but another region is removed, too; expected one",
                 i);
        for (const RimSide& side : rim_of(scene.added[i].volume->geometry, {}, 0).sides)
            one.effects.clip.remove.push_back(side.plane);
    }
    return one;
}

Scene scene_of_volume(const Scene& scene, std::size_t number, const VolumeGeometry& first) {
    Scene one = scene_of_volume(scene, number);
    for (std::size_t i = 0; i < scene.added.size(); ++i) {
        if (!scene.added[i].replaces) continue;
        std::vector<VolumeGeometry> others;
        for (std::size_t k = 0; k <= scene.added.size(); ++k)
            if (k != i + 1 && has_matter(scene_of_volume(scene, k)))
                others.push_back(k == 0 ? first : scene.added[k - 1].volume->geometry);
        one.rim = rim_of(scene.added[i].volume->geometry, others, scene.added[i].rim);
        one.rim.within = i + 1 == number;
        if (one.rim.within) break;
    }
    return one;
}

Scene scene_of_surfaces(Scene scene) {
    if (!scene.rim.any()) return scene;
    Clip& clip = scene.effects.clip;
    if (!scene.rim.within) clip.remove.clear();
    for (const RimSide& side : scene.rim.sides)
        if (!scene.rim.within)
            clip.remove.push_back(side.plane);
        else if (side.inner)
            clip.keep.push_back(side.plane);
    if (clip.keep.size() > kMaxClipPlanes)
        fail(
            "volumes: a volume that replaces the others has {} clip planes with the sides of its rim, expected at most "
            "{}",
            clip.keep.size(), kMaxClipPlanes);
    return scene;
}

Scene scene_of_kernels(Scene scene) {
    if (scene.rim.any() && !scene.rim.within) scene.effects.clip.remove.clear();
    return scene;
}

bool has_matter(const Scene& scene) {
    const auto absorbs = [](const auto& at) { return at.extinction > 0; };
    return scene.transfer.empty() ? std::ranges::any_of(scene.materials, absorbs)
                                  : std::ranges::any_of(scene.transfer, absorbs);
}

void validate(const Scene& scene) {
    if (scene.added.size() >= kMaxVolumes)
        fail("scene volumes: {} volumes, expected at most {}", scene.added.size() + 1, kMaxVolumes);
    for (std::size_t i = 0; i < scene.added.size(); ++i) {
        if (!scene.added[i].volume) fail("scene volumes[{}]: it has no samples; expected a volume that is read", i);
        try {
            validate(scene_of_volume(scene, i + 1));
        } catch (const Error& error) {
            fail("volumes[{}]: {}", i, error.what());
        }
    }
    const std::size_t count = scene.iso_values.size(), fewest = scene.transfer.empty() ? 1 : 0;
    if (count < fewest || count > kMaxIsoValues) {
        fail("scene iso_values: {} values, expected {} to {}", count, fewest, kMaxIsoValues);
    }
    for (std::size_t i = 0; i < count; ++i) {
        const double value = scene.iso_values[i];
        if (!std::isfinite(value)) fail("scene iso_values[{}]: {} is not finite", i, value);
        if (i > 0 && !(value > scene.iso_values[i - 1])) {
            fail("scene iso_values[{}]: {} is not above the one before ({})", i, value, scene.iso_values[i - 1]);
        }
    }
    check_materials(scene);
    check_transfer(scene.transfer);
    for (std::size_t i = 0; i < scene.label_colors.size(); ++i)
        check_color(fmt::format("label_colors[{}]", i), scene.label_colors[i]);
    check_color("background", scene.background);
    check_share("ambient", scene.ambient);
    check_lights(scene.lights);
    validate(scene.effects);
}

bool occludes_ambient(const Scene& scene) {
    return scene.effects.occlusion.has_value() && !scene.lights.empty();
}

std::vector<std::size_t> shadow_lights(const Scene& scene) {
    std::vector<std::size_t> numbers;
    for (std::size_t i = 0; i < scene.lights.size(); ++i)
        if (scene.lights[i].shadows) numbers.push_back(i);
    return numbers;
}

}  // namespace edgesplat
