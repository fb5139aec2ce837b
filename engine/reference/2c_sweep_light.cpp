#include "engine/reference/2c_sweep_light.h"

#include <algorithm>
#include <cmath>

#include "engine/reference/volume_piece.h"

namespace edgesplat::reference {

glm::dvec3 lit_place(const SplatRecord& record, const Field& field, const VolumeGeometry& geometry, double band,
                     const glm::dvec3& to_light, double pixel, const IndexClip& clip) {
    SurfacePoint s = surface_point(record.edge, band, false, geometry);
    if (is_wall(record.edge, band) && glm::dot(s.normal, to_light) < 0)
        s = surface_point(record.edge, band, true, geometry);
    s = at_cut(s, record.edge, glm::dvec3(field.voxel(record.voxel)), clip, geometry);
    const double cosine = glm::dot(s.normal, to_light);
    const double slant = pixel * std::sqrt(std::max(1 - cosine * cosine, 0.0));
    const double lift = std::clamp(slant + 0.5 * s.voxel, kShortestLift * s.voxel, kLongestLift * s.voxel);
    return glm::dvec3(field.voxel(record.voxel)) + s.foot + std::min(lift, s.room) * s.step;
}

double light_reach(std::span<const SplatRecord> records, const Field& field, const Scene& scene,
                   const VolumeGeometry& geometry, const Footprints& footprints, const Light& light,
                   const glm::dvec3& place, const IndexClip& clip) {
    const glm::dvec3 way =
        light.kind == Light::Kind::Directional ? light.direction : light.position - geometry.to_world(place);
    const glm::dvec3 to_light = glm::inverse(geometry.index_to_world_axes) * way;
    const double length = light.kind == Light::Kind::Directional ? HUGE_VAL : glm::length(to_light);
    const glm::dvec3 u = glm::normalize(to_light);
    const double path = glm::length(geometry.index_to_world_axes * u);
    const VolumePiece inside = piece_in_volume(geometry.dims, place, u);
    const auto pieces = clip.kept_along(place, u);
    double tau = 0;
    for (const SplatRecord& record : records) {
        const glm::dvec3 v = place - glm::dvec3(field.voxel(record.voxel));
        const double along = glm::dot(v, u);
        const glm::dvec3 p = v - along * u;
        if (glm::dot(p, p) >= footprints.farthest_reach() * footprints.farthest_reach()) continue;
        Slice slice{along, along + length};
        if (footprints.cuts(record.edge))
            slice = {std::max(slice.low, along + inside.low), std::min(slice.high, along + inside.high)};
        for (const KeptPiece& piece : pieces) {
            const Slice kept{std::max(slice.low, along + piece.first), std::min(slice.high, along + piece.last)};
            if (piece.empty() || !(kept.low < kept.high)) continue;
            tau += record.extinction(scene) * path * footprints.along_slice(record.edge, p, u, kept);
        }
    }
    return std::exp(-tau);
}

}  // namespace edgesplat::reference
