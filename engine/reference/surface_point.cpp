#include "engine/reference/surface_point.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "footprints/kernel.h"

namespace edgesplat::reference {

bool is_wall(const VoxelEdge& edge, double band) {
    return edge.has_edge && edge.D2 < band;
}

SurfacePoint surface_point(const VoxelEdge& edge, double band, bool turned, const VolumeGeometry& geometry) {
    SurfacePoint s;
    if (!edge.has_normal) return s;
    const glm::dmat3 to_index = glm::inverse(geometry.index_to_world_axes);
    const bool wall = is_wall(edge, band);
    const double side = edge.upper == (wall && turned) ? 1 : -1;
    s.normal = glm::normalize(glm::transpose(to_index) * (side * edge.n));
    s.step = to_index * s.normal;
    s.voxel = 1 / glm::length(s.step);
    s.room = edge.upper && !wall ? 0.5 * (edge.D + edge.D2) * s.voxel : std::numeric_limits<double>::infinity();
    if (edge.has_edge) s.foot = (wall && side < 0 ? -edge.D2 : edge.D) * edge.n;
    return s;
}

SurfacePoint at_cut(const SurfacePoint& uncut, const VoxelEdge& edge, const glm::dvec3& x, const IndexClip& clip,
                    const VolumeGeometry& geometry) {
    const auto nearest = [&](const std::vector<IndexPlane>& planes) {
        return std::ranges::max_element(planes, {}, [&](const IndexPlane& plane) { return plane.distance(x); });
    };
    const auto keep = nearest(clip.keep), remove = nearest(clip.remove);
    const double infinite = std::numeric_limits<double>::infinity();
    const double to_keep = keep == clip.keep.end() ? infinite : std::abs(keep->distance(x));
    const double to_hole = remove == clip.remove.end() ? infinite : std::abs(remove->distance(x));
    const double own = edge.has_edge ? std::min(std::abs(edge.D), std::abs(edge.D2)) : infinite;
    if (std::min(to_keep, to_hole) >= std::min(own, kKernelRadius)) return uncut;
    const bool hole = to_hole < to_keep;
    const IndexPlane& plane = hole ? *remove : *keep;
    SurfacePoint s;
    const glm::dmat3 to_index = glm::inverse(geometry.index_to_world_axes);
    s.foot = -plane.distance(x) * plane.normal;
    s.normal = glm::normalize(glm::transpose(to_index) * (hole ? -plane.normal : plane.normal));
    s.step = to_index * s.normal;
    s.voxel = 1 / glm::length(s.step);
    s.room = infinite;
    return s;
}

}  // namespace edgesplat::reference
