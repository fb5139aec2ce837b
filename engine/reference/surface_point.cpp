#include "engine/reference/surface_point.h"

#include <algorithm>

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

}  // namespace edgesplat::reference
