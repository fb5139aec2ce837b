#include "engine/reference/2c_cast_shadows.h"

#include <algorithm>
#include <cmath>

#include "engine/geometry/in_double.h"

namespace edgesplat::reference {
namespace {

/// From `from` (index space) to the light, index space; of a directional light any length.
glm::dvec3 way_to_light(const Light& light, const VolumeGeometry& geometry, const glm::dvec3& from) {
    if (light.kind == Light::Kind::Point) return geometry.to_index(light.position) - from;
    return glm::inverse(geometry.index_to_world_axes) * light.direction;
}

}  // namespace

SurfacePoint lit_point(const SplatRecord& record, const Field& field, const VolumeGeometry& geometry, double band,
                       const Light& light, const IndexClip& clip) {
    const glm::dvec3 voxel(field.voxel(record.voxel));
    SurfacePoint s = surface_point(record.edge, band, false, geometry);
    const glm::dvec3 towards = geometry.index_to_world_axes * way_to_light(light, geometry, voxel);
    if (is_wall(record.edge, band) && glm::dot(s.normal, towards) < 0)
        s = surface_point(record.edge, band, true, geometry);
    return at_cut(s, record.edge, voxel, clip, geometry);
}

double light_reach(const SurfacePoint& point, const glm::ivec3& voxel, const VolumeGeometry& own,
                   const LightMatter& matter, const Light& light) {
    const auto& [field, scaled, scene, geometry] = matter;
    const IndexClip clip = index_clip(scene.effects.clip, geometry);
    const double lift = std::min(kShadowLift * point.voxel, point.room);
    glm::dvec3 from = glm::dvec3(voxel) + point.foot + lift * point.step;
    if (&own != &geometry) from = geometry.to_index(own.to_world(from));
    const glm::dvec3 way = way_to_light(light, geometry, from);
    const double length = light.kind == Light::Kind::Point ? glm::length(way) : 1e9;
    const glm::dvec3 u = length > 0 ? glm::normalize(way) : glm::dvec3(0, 0, 1);
    const double mm = static_cast<double>(shader::SHADOW_STEP) * glm::length(geometry.index_to_world_axes * u);
    double sum = 0;
    for (int ray_number = 0; ray_number < edgesplat::geometry::SHADOW_RAYS; ++ray_number) {
        const edgesplat::geometry::LightRay ray =
            edgesplat::geometry::light_ray(from, u, length, ray_number, field.dims);
        double tau = 0;
        for (int k = ray.first; k < ray.last && tau < kDark; ++k) {
            const glm::dvec3 p = ray.start + static_cast<double>(k) * ray.step;
            if (!field.has_data(field.offset(field.clamped(glm::ivec3(glm::floor(p + 0.5)))))) continue;
            if (!clip.cuts_away(p)) tau += mm * extinction_of(std::max(sample(field, p), 0.0), scaled, scene);
        }
        sum += std::exp(-tau);
    }
    return sum / edgesplat::geometry::SHADOW_RAYS;
}

}  // namespace edgesplat::reference
