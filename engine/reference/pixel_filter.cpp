#include "engine/reference/pixel_filter.h"

#include <algorithm>
#include <cmath>

#include "engine/geometry/in_double.h"
#include "engine/reference/3_select_footprints.h"
#include "footprints/kernel.h"

namespace edgesplat::reference {

double PixelFilter::rho2(double rho2_of_ray, const glm::dvec2& at) const {
    const glm::dvec2 from_centre = at - centre;
    return of_pixels * glm::dot(from_centre, from_centre) + of_voxels * rho2_of_ray;
}

double matter_of_voxel(const VoxelEdge& edge, const Footprints& footprints) {
    const bool carried = edge.deepest != FACE_DEPTH;  // translucent: voxels beside the matter emit splats of it, too
    return footprints.warped(edge) ? geometry::matter_between(edge.D, edge.D2, carried) : 1;
}

PixelFilter pixel_filter(const View& view, const SplatRecord& record, const glm::dvec3& x,
                         const Footprints& footprints) {
    PixelFilter f;
    if (!(view.low_pass > 0)) return f;
    const double around = footprints.reach(record.edge);
    const glm::dvec3 steepest = glm::transpose(view.geometry.index_to_world_axes) * view.frame.forward;
    f.depth = view.depth(x);
    if (!(f.depth >= 2 * around * glm::length(steepest))) return f;

    const glm::dvec3 u = glm::normalize(x - view.eye_index);
    const double side = view.low_pass * f.depth * 2 * view.frame.tan_half_y / view.height;
    const geometry::LowPass low_pass =
        geometry::low_pass(side * (view.world_to_index * view.frame.right),
                           side * (view.world_to_index * view.frame.up), u, footprints.kernel().radius);
    f.share = low_pass.share;
    f.of_pixels = low_pass.of_pixels / (view.low_pass * view.low_pass);
    f.of_voxels = low_pass.of_voxels;
    f.amplitude = matter_of_voxel(record.edge, footprints) * std::sqrt(f.of_voxels);
    f.reach = low_pass.reach;
    f.centre = view.pixel_of(x);
    return f;
}

}  // namespace edgesplat::reference
