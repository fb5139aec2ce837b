#include "engine/scene/clip_planes.h"

#include <algorithm>
#include <cmath>

namespace edgesplat {
namespace {

std::vector<IndexPlane> in_index_space(const std::vector<Plane>& planes, const VolumeGeometry& geometry,
                                       const glm::dvec3& origin) {
    std::vector<IndexPlane> result;
    const glm::dvec3 at = geometry.to_world(origin);
    for (const Plane& plane : planes) {
        // Scaled first to avoid overflow and underflow of the square.
        const double largest = std::max({std::abs(plane.normal.x), std::abs(plane.normal.y), std::abs(plane.normal.z)});
        const glm::dvec3 world = plane.normal / largest;
        const glm::dvec3 normal = glm::transpose(geometry.index_to_world_axes) * world;
        const double length = glm::length(normal);
        result.push_back({normal / length, glm::dot(world, at - plane.point) / length});
    }
    return result;
}

/// Interval of the line on the near side of all planes.
struct Inside {
    double first = -std::numeric_limits<double>::infinity();
    double last = std::numeric_limits<double>::infinity();
    glm::dvec3 entered{0}, left{0};  ///< normals of the planes that bound it
};

Inside inside_of(const std::vector<IndexPlane>& planes, const glm::dvec3& origin, const glm::dvec3& u) {
    constexpr double kParallel = 1e-12;
    Inside inside;
    for (const IndexPlane& plane : planes) {
        double along = glm::dot(plane.normal, u);
        along = along < 0 ? std::min(along, -kParallel) : std::max(along, kParallel);
        const double t = -plane.distance(origin) / along;
        if (along > 0 && t < inside.last) {
            inside.last = t;
            inside.left = plane.normal;
        }
        if (along < 0 && t > inside.first) {
            inside.first = t;
            inside.entered = plane.normal;
        }
    }
    return inside;
}

}  // namespace

bool IndexClip::cuts_away(const glm::dvec3& x, double radius) const {
    const bool beyond =
        std::any_of(keep.begin(), keep.end(), [&](const IndexPlane& plane) { return plane.distance(x) > radius; });
    const bool within = !remove.empty() && std::all_of(remove.begin(), remove.end(), [&](const IndexPlane& plane) {
        return plane.distance(x) < -radius;
    });
    return beyond || within;
}

std::array<KeptPiece, 2> IndexClip::kept_along(const glm::dvec3& origin, const glm::dvec3& u) const {
    const Inside kept = inside_of(keep, origin, u);
    KeptPiece before{kept.first, kept.last, {}}, behind{0, 0, {}};
    if (kept.entered != glm::dvec3(0)) before.face = kept.entered;
    if (remove.empty()) return {before, behind};
    const Inside gone = inside_of(remove, origin, u);
    if (!(gone.first < gone.last)) return {before, behind};
    behind = {std::max(kept.first, gone.last), kept.last, gone.last > kept.first ? -gone.left : before.face};
    before.last = std::min(kept.last, gone.first);
    return {before, behind};
}

IndexClip index_clip(const Clip& clip, const VolumeGeometry& geometry, const glm::dvec3& origin) {
    return {in_index_space(clip.keep, geometry, origin), in_index_space(clip.remove, geometry, origin)};
}

}  // namespace edgesplat
