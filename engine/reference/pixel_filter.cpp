#include "engine/reference/pixel_filter.h"

#include <algorithm>
#include <cmath>

#include "engine/reference/3_select_footprints.h"
#include "footprints/kernel.h"

namespace edgesplat::reference {

double PixelFilter::rho2(double rho2_of_ray, const glm::dvec2& at) const {
    const glm::dvec2 from_centre = at - centre;
    return of_pixels * glm::dot(from_centre, from_centre) + of_voxels * rho2_of_ray;
}

double matter_of_voxel(const VoxelEdge& edge, const Footprints& footprints) {
    const bool carried = edge.deepest != FACE_DEPTH;  // translucent: voxels beside the matter emit splats of it, too
    if (!footprints.warped(edge) || (!carried && edge.D + edge.D2 < 1)) return 1;
    const auto behind_face = [&](double distance) {
        return distance < (carried ? 0.5 : 1) ? std::max(distance + 0.5, 0.0) : 1.0;
    };
    return std::max(behind_face(edge.D) + behind_face(edge.D2) - 1, 0.0);
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
    const auto across_ray = [&](const glm::dvec3& world) {
        const glm::dvec3 b = side * (view.world_to_index * world);
        return b - glm::dot(b, u) * u;
    };
    const glm::dvec3 across = across_ray(view.frame.right), down = across_ray(view.frame.up);
    const double a = glm::dot(across, across), b = glm::dot(down, down), c = glm::dot(across, down);
    const double det = a * b - c * c, trace = a + b, widening = 1 + trace + det;
    const double t = std::clamp((std::sqrt(std::max(a, b)) - 0.5) / 0.5, 0.0, 1.0);
    f.share = t * t * (3 - 2 * t);
    f.of_pixels = det / widening / (view.low_pass * view.low_pass);
    f.of_voxels = 1 / widening;
    f.amplitude = matter_of_voxel(record.edge, footprints) * std::sqrt(f.of_voxels);
    f.reach = footprints.kernel().radius * std::sqrt(1 + trace / 2 + std::sqrt(std::max(trace * trace / 4 - det, 0.0)));
    f.centre = view.pixel_of(x);
    return f;
}

}  // namespace edgesplat::reference
