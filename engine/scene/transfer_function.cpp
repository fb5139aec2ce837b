#include "engine/scene/transfer_function.h"

#include <algorithm>
#include <limits>

#include "engine/volume/filters.h"
#include "engine/volume/grid.h"
#include "footprints/face.h"
#include "shaders/shared/limits.h"

namespace edgesplat {

TransferPoint transfer_at(std::span<const TransferPoint> points, double value) {
    const auto above = std::ranges::upper_bound(points, value, {}, &TransferPoint::value);
    TransferPoint at = above == points.begin() ? points.front() : *(above - 1);
    if (above != points.begin() && above != points.end()) {
        const double t = (value - at.value) / (above->value - at.value);
        at.color = glm::mix(at.color, above->color, t);
        at.extinction += t * (above->extinction - at.extinction);
    }
    at.value = value;
    return at;
}

ExtinctionRange extinctions_of(const Scene& scene, std::size_t material) {
    if (scene.transfer.empty()) {
        const double own = scene.materials[material].extinction;
        return {own, own};
    }
    constexpr double infinity = std::numeric_limits<double>::infinity();
    const double low = material == 0 ? -infinity : scene.iso_values[material - 1];
    const double high = material == scene.iso_values.size() ? infinity : scene.iso_values[material];
    ExtinctionRange range{infinity, 0};
    const auto add = [&](double extinction) {
        range.least = std::min(range.least, extinction);
        range.most = std::max(range.most, extinction);
    };
    // The function is linear between its points and the interval's ends, and constant beyond the outermost points.
    add(material == 0 ? scene.transfer.front().extinction : transfer_at(scene.transfer, low).extinction);
    add(high == infinity ? scene.transfer.back().extinction : transfer_at(scene.transfer, high).extinction);
    for (const TransferPoint& point : scene.transfer)
        if (point.value > low && point.value < high) add(point.extinction);
    return range;
}

std::uint32_t translucent_materials(const Scene& scene, const VolumeGeometry& geometry) {
    constexpr double kPerVoxel = 4;
    std::uint32_t translucent_mask = 0;
    for (std::size_t m = 0; m < scene.materials.size(); ++m) {
        const ExtinctionRange range = extinctions_of(scene, m);
        const bool is_opaque = range.least * shortest_spacing(geometry) >= kPerVoxel;
        if (range.most > 0 && !is_opaque) translucent_mask |= 1U << m;
    }
    return translucent_mask;
}

std::uint32_t materials_carried_beside(const Settings& settings, const Scene& scene, const VolumeGeometry& geometry) {
    return draws_faces(settings) ? translucent_materials(scene, geometry) : 0;
}

bool all_matter_is_opaque(const Scene& scene, const VolumeGeometry& geometry) {
    return translucent_materials(scene, geometry) == 0;
}

namespace {

/// Whether all matter is opaque and no clip plane cuts kernels.
bool is_whole_and_opaque(const Scene& scene, const VolumeGeometry& geometry) {
    return scene.effects.clip.empty() && all_matter_is_opaque(scene, geometry);
}

}  // namespace

bool draws_opaque_faces(const Settings& settings, const Scene& scene, const VolumeGeometry& geometry) {
    return draws_faces(settings) && is_whole_and_opaque(scene, geometry);
}

const Kernel& uncut_kernel(const Settings& settings, const Scene& scene, const VolumeGeometry& geometry) {
    return draws_opaque_faces(settings, scene, geometry) ? kNarrowKernel : kKernel;
}

double table_depth(const Scene& scene, const VolumeGeometry& geometry) {
    return is_whole_and_opaque(scene, geometry) ? FACE_DEPTH : 0;
}

bool has_single_piece(const Settings& settings, const Scene& scene, const VolumeGeometry& geometry) {
    return draws_opaque_faces(settings, scene, geometry) && settings.sheets != SheetCut::Sliced;
}

bool draws_surfaces(const Settings& settings, const Scene& scene, const Volume& volume) {
    const Effects& effects = scene.effects;
    // Light that arrives at splats is unknown where planes cut out a piece: no splat lies there.
    const bool lit = effects.clip.remove.empty() || (shadow_lights(scene).empty() && !occludes_ambient(scene));
    const bool plain = !effects.antialias && scene.transfer.empty();
    if (!lit || !plain || settings.opaque != OpaqueMatter::Surfaces) return false;
    const auto matter = std::ranges::any_of(scene.materials, [](const Material& m) { return m.extinction > 0; });
    return matter && !draws_missing_samples(scene, volume) && all_matter_is_opaque(scene, volume.geometry) &&
           allows_surfaces(canonical_settings(settings, scene));
}

Scene scene_of_bodies(const Scene& scene) {
    Scene bodies = scene;
    bodies.iso_values.clear();
    bodies.materials = {scene.materials.front()};
    for (std::size_t m = 1; m < scene.materials.size(); ++m) {
        if ((scene.materials[m].extinction > 0) == (scene.materials[m - 1].extinction > 0)) continue;
        bodies.iso_values.push_back(scene.iso_values[m - 1]);
        bodies.materials.push_back(scene.materials[m]);
    }
    return bodies;
}

double solid_chord(const Scene& scene, const VolumeGeometry& geometry) {
    double least = std::numeric_limits<double>::infinity();
    for (const Material& material : scene.materials)
        if (material.extinction > 0) least = std::min(least, material.extinction);
    return static_cast<double>(shader::SURFACE_SOLID) / (least * shortest_spacing(geometry));
}

bool draws_missing_samples(const Scene& scene, const Volume& volume) {
    if (!volume.no_data) return false;
    if (!scene.transfer.empty()) return true;
    const auto above = std::ranges::upper_bound(scene.iso_values, static_cast<double>(volume.min_value));
    return scene.materials[static_cast<std::size_t>(above - scene.iso_values.begin())].extinction > 0;
}

std::vector<TransferPoint> scaled_transfer(const Scene& scene, const Volume& volume) {
    if (scene.transfer.empty()) return {};
    if (!(volume.max_value > volume.min_value)) {
        TransferPoint only = transfer_at(scene.transfer, static_cast<double>(volume.min_value));
        only.value = 0;
        return {only};
    }
    // Samples lie in 0..1; points further away than this are clamped.
    constexpr double far = 1e30;
    std::vector<TransferPoint> points = scene.transfer;
    for (TransferPoint& point : points)
        point.value = static_cast<float>(std::clamp(scaled_value(volume, point.value), -far, far));
    return points;
}

}  // namespace edgesplat
