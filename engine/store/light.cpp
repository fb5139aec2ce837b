#include "engine/store/light.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace edgesplat {
namespace {

// A directional light is a point light this many radii of the box away: rays diverge by less than 1/50 voxel in 1000.
constexpr double kFarLight = 1e5;
// A point light takes one picture if the box is within this slope of its axis (50 degrees), else up to six (a cube).
constexpr double kWidestSlope = 1.2;
// Optical depth at which a light's pixel saturates: 6e-6 of the light remain, less than a unorm16 step.
constexpr float kDark = 12.0F;
// Quadrature nodes per piece of a footprint. Error for slices of a voxel, relative to the peak: 1e-3 (10 nodes: 1e-5).
constexpr std::uint32_t kLightNodes = 4;
// Thinnest layer, voxels. Thinner layers resolve nothing more, since kernels have a radius of 1.6 voxels.
constexpr double kThinnestLayer = 1.0;

/// Corners of the voxel box, widened by the kernels' reach (voxels); world coordinates.
std::array<glm::dvec3, 8> corners_of(const VolumeGeometry& geometry, const glm::ivec3& low, const glm::ivec3& high,
                                     double reach) {
    std::array<glm::dvec3, 8> corners;
    for (std::size_t i = 0; i < corners.size(); ++i) {
        const glm::bvec3 top((i & 1U) != 0, (i & 2U) != 0, (i & 4U) != 0);
        corners.at(i) = geometry.to_world(glm::mix(glm::dvec3(low) - reach, glm::dvec3(high) + reach, top));
    }
    return corners;
}

double degrees_of_slope(double slope) {
    return glm::degrees(2 * std::atan(slope));
}

/// Largest slope of a corner against the view axis, horizontally or vertically; infinite if a corner is behind the eye.
double widest_slope(const std::array<glm::dvec3, 8>& corners, const Camera& camera) {
    const CameraFrame frame = camera_frame(camera);
    double widest = 0;
    for (const glm::dvec3& corner : corners) {
        const glm::dvec3 v = corner - frame.eye;
        const double z = glm::dot(v, frame.forward);
        if (!(z > 0)) return INFINITY;
        widest = std::max({widest, std::abs(glm::dot(v, frame.right)) / z, std::abs(glm::dot(v, frame.up)) / z});
    }
    return widest;
}

/// Whether all corners lie beyond the same side of the picture, or behind the eye.
bool misses(const std::array<glm::dvec3, 8>& corners, const Camera& camera) {
    const CameraFrame frame = camera_frame(camera);
    const double s = frame.tan_half_y;
    const std::array sides{frame.forward, s * frame.forward - frame.right, s * frame.forward + frame.right,
                           s * frame.forward - frame.up, s * frame.forward + frame.up};
    return std::ranges::any_of(sides, [&](const glm::dvec3& side) {
        return std::ranges::none_of(corners, [&](const glm::dvec3& c) { return glm::dot(c - frame.eye, side) > 0; });
    });
}

/// The scene's matter and clip planes, without lights and other effects.
Scene only_matter(const Scene& scene) {
    Scene dark = scene;
    dark.lights.clear();
    dark.effects = {};
    dark.effects.clip = scene.effects.clip;
    return dark;
}

}  // namespace

Matter::Matter(const Scene& scene) : transfer(scene.transfer), clip(scene.effects.clip) {
    for (const Material& material : scene.materials)
        extinction.push_back(material.extinction);
    for (TransferPoint& point : transfer)
        point.color = {};
}

OcclusionPlan plan_occlusion(const Scene& scene) {
    return {Matter(scene), scene.effects.occlusion->radius};
}

ShadowPlan plan_shadows(const Scene& scene, const Settings& settings) {
    ShadowPlan plan{Matter(scene), {}, scene.effects.shadows, settings};
    for (const std::size_t i : shadow_lights(scene)) {
        const Light& light = scene.lights[i];
        const bool far = light.kind == Light::Kind::Directional;
        plan.lights.push_back({.kind = light.kind,
                               .direction = far ? light.direction : Light{}.direction,
                               .position = far ? Light{}.position : light.position});
    }
    // With slices the optical depth at every layer is exact for any kernel size.
    plan.settings.sheets = SheetCut::Sliced;
    plan.settings.sheet_spacing = std::max(plan.settings.sheet_spacing, kThinnestLayer);
    plan.settings.sheet_format = SheetFormat::Layers;
    plan.settings = canonical_settings(plan.settings, scene);
    plan.settings.saturation = Settings{}.saturation;
    return plan;
}

std::vector<Camera> light_views(const Light& light, const VolumeGeometry& geometry, const glm::ivec3& box_low,
                                const glm::ivec3& box_high, double reach, int resolution) {
    const auto corners = corners_of(geometry, box_low, box_high, reach);
    const glm::dvec3 middle = geometry.to_world(0.5 * (glm::dvec3(box_low) + glm::dvec3(box_high)));
    // A margin of two pixels, so that no lookup at a splat crosses the picture's border.
    const double spare = resolution / (resolution - 2.0);
    Camera camera;
    if (light.kind == Light::Kind::Directional) {
        double farthest = 0;
        for (const glm::dvec3& corner : corners)
            farthest = std::max(farthest, glm::length(corner - middle));
        camera.direction = -glm::normalize(light.direction);
        camera.eye = middle - kFarLight * farthest * camera.direction;
    } else {
        camera.eye = light.position;
        camera.direction = middle - light.position;
    }
    if (camera.direction != glm::dvec3(0)) {
        const double slope = widest_slope(corners, camera);
        if (slope <= kWidestSlope) {
            camera.fov_y = degrees_of_slope(slope * spare);
            return {camera};
        }
    }
    std::vector<Camera> cube;
    for (int side = 0; side < 6; ++side) {
        camera.direction = glm::dvec3(0);
        camera.direction[side / 2] = side % 2 == 0 ? 1 : -1;
        camera.up = glm::dvec3(0);
        camera.up[(side / 2 + 1) % 3] = 1;
        camera.fov_y = degrees_of_slope(spare);
        if (!misses(corners, camera)) cube.push_back(camera);
    }
    return cube;
}

FramePlan plan_light_frame(const Volume& volume, const Scene& scene, const ShadowPlan& shadows, const Camera& view,
                           const SplatExtent& splats, double reach) {
    const auto& geometry = volume.geometry;
    const CameraFrame frame = camera_frame(view);
    const glm::dmat3& axes = geometry.index_to_world_axes;
    const double voxel = 1.0 / glm::length(glm::inverse(axes) * frame.forward);
    const double around = reach * glm::length(glm::transpose(axes) * frame.forward);
    double nearest = INFINITY, farthest = 0;
    for (const glm::dvec3& corner : corners_of(geometry, splats.low, splats.high, 0)) {
        const double z = glm::dot(frame.forward, corner - frame.eye);
        nearest = std::min(nearest, z - around);
        farthest = std::max(farthest, z + around);
    }
    // Thickness for layers - 1 sheets: the first sheet may begin before `nearest`, which adds one.
    Settings settings = shadows.settings;
    const double thickness = (farthest - std::max(nearest, 0.0)) / (shadows.quality.layers - 1);
    settings.sheet_spacing = std::max(settings.sheet_spacing, thickness / voxel);

    FramePlan plan = plan_frame(volume, only_matter(scene), view, settings, glm::ivec2(shadows.quality.resolution),
                                shader::PAYLOAD_COLOR, splats, reach);
    plan.variant.payload = shader::PAYLOAD_TAU;
    plan.variant.nodes = kLightNodes;
    plan.params.saturation = kDark;
    return plan;
}

std::uint64_t light_layer_bytes(const FramePlan& plan) {
    const auto side = static_cast<std::uint64_t>(plan.params.size.x);
    return side * side * plan.params.sheet_count * sizeof(float);
}

}  // namespace edgesplat
