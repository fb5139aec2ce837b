#include "engine/reference/surface_point.h"

#include "engine/reference/field_geometry.h"

namespace edgesplat::geometry {
namespace {

/// engine/geometry/surface_point.glsl with the planes that it asks for.
struct SurfacePointGeometry {
    explicit SurfacePointGeometry(const IndexClip& planes = {})
        : CLIP_KEEP(static_cast<uint>(planes.keep.size())),
          CLIP_REMOVE(static_cast<uint>(planes.remove.size())),
          clip(planes) {}

    uint CLIP_KEEP, CLIP_REMOVE;
    IndexClip clip;

    vec4 keep_plane(uint i) const { return {clip.keep[i].normal, clip.keep[i].offset}; }
    vec4 remove_plane(uint i) const { return {clip.remove[i].normal, clip.remove[i].offset}; }

#include "engine/geometry/surface_point.glsl"
};

mat3 normal_to_world(const VolumeGeometry& grid) {
    return transpose(inverse(grid.index_to_world_axes));
}

reference::SurfacePoint public_point(const SurfacePointGeometry::SurfacePoint& s) {
    return {s.foot, s.normal, s.step, s.voxel, s.room};
}

}  // namespace
}  // namespace edgesplat::geometry

namespace edgesplat::reference {

bool is_wall(const VoxelEdge& edge, double band) {
    return geometry::SurfacePointGeometry().is_wall(geometry::edge_of(edge), band);
}

SurfacePoint surface_point(const VoxelEdge& edge, double band, bool turned, const VolumeGeometry& grid) {
    return geometry::public_point(geometry::SurfacePointGeometry().surface_point(geometry::edge_of(edge), band, turned,
                                                                                 geometry::normal_to_world(grid)));
}

SurfacePoint at_cut(const SurfacePoint& uncut, const VoxelEdge& edge, const glm::dvec3& x, const IndexClip& clip,
                    const VolumeGeometry& grid) {
    return geometry::public_point(
        geometry::SurfacePointGeometry(clip).at_cut({uncut.foot, uncut.normal, uncut.step, uncut.voxel, uncut.room},
                                                    geometry::edge_of(edge), x, geometry::normal_to_world(grid)));
}

}  // namespace edgesplat::reference
