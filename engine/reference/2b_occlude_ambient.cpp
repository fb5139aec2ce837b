#include "engine/reference/2b_occlude_ambient.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "engine/geometry/in_double.h"
#include "engine/scene/clip_planes.h"
#include "engine/scene/transfer_function.h"

namespace edgesplat::reference {

double extinction_of(double value, const ScaledScene& scaled, const Scene& scene) {
    if (!scaled.transfer.empty()) return transfer_at(scaled.transfer, value).extinction;
    return scene.materials[static_cast<std::size_t>(scaled.material(value))].extinction;
}

double ambient_reach(const SplatRecord& record, const Field& field, const ScaledScene& scaled, const Scene& scene,
                     const VolumeGeometry& geometry, double band, double radius, bool turned, int rays) {
    const glm::dvec3 voxel(field.voxel(record.voxel));
    const IndexClip clip = index_clip(scene.effects.clip, geometry);
    const SurfacePoint s =
        at_cut(surface_point(record.edge, band, turned, geometry), record.edge, voxel, clip, geometry);
    return ambient_reach_at(s, field.voxel(record.voxel), geometry, {field, scaled, scene, geometry}, radius, rays);
}

double ambient_reach_at(const SurfacePoint& s, const glm::ivec3& voxel, const VolumeGeometry& own,
                        const LightMatter& matter, double radius, int rays) {
    const auto& [field, scaled, scene, geometry] = matter;
    const IndexClip clip = index_clip(scene.effects.clip, geometry);
    glm::dvec3 start = glm::dvec3(voxel) + s.foot + std::min(kOcclusionLift * s.voxel, s.room) * s.step;
    if (&own != &geometry) start = geometry.to_index(own.to_world(start));
    const glm::dmat3 to_index = glm::inverse(geometry.index_to_world_axes);
    const bool sphere = s.normal == glm::dvec3(0);
    const glm::dmat3 frame = sphere ? glm::dmat3(1) : edgesplat::geometry::frame_of(s.normal);
    const glm::uvec3 v(voxel);
    const std::uint32_t turn = v.x * 3518319155U + v.y * 2882110345U + v.z * 2360945575U;
    const double phase = (turn >> 8U) * (2 * std::numbers::pi / 16777216.0);
    const double golden = std::numbers::pi * (3 - std::sqrt(5.0));

    double sum = 0;
    for (int k = 0; k < rays; ++k) {
        const double share = (k + 0.5) / rays, angle = phase + k * golden;
        const double up = sphere ? 1 - 2 * share : std::sqrt(1 - share);
        const double across = std::sqrt(1 - up * up);
        const glm::dvec3 u = to_index * (frame * glm::dvec3(across * std::cos(angle), across * std::sin(angle), up));
        const double steps = std::clamp(std::ceil(radius * glm::length(u) - 0.01), 1.0, double{kOcclusionSteps});
        const double dl = radius / steps;
        double tau = 0;
        for (int i = 0; i < static_cast<int>(steps) && tau < kDark; ++i) {
            const glm::ivec3 p(glm::floor(start + (i + 0.5) * dl * u + 0.5));
            if (field.clamped(p) != p || !field.has_data(field.offset(p)) || clip.cuts_away(glm::dvec3(p))) continue;
            tau += dl * extinction_of(field.at(p), scaled, scene);
        }
        sum += std::exp(-tau);
    }
    return sum / rays;
}

}  // namespace edgesplat::reference
