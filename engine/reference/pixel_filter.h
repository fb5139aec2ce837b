// Antialiasing of splats that are smaller than a pixel (docs/method.md, pass 5, "Antialiasing").
#pragma once

#include "engine/reference/2_collect_splats.h"
#include "engine/reference/footprints.h"

namespace edgesplat::reference {

struct View;

/// How a splat's footprint is widened by a pixel: where a ray passes the voxel at x, rho2 = |x|^2 becomes
/// of_pixels * (distance in pixels)^2 + of_voxels * rho2.
struct PixelFilter {
    double share = 0;      ///< of the widened footprint in what is drawn, [0, 1]
    double of_pixels = 0;  ///< det A / det(1 + A), A the form of the pixel's sides across the ray, voxels
    double of_voxels = 1;  ///< 1 / det(1 + A)
    double amplitude = 1;  ///< of the kernel: the matter that it stands for, times of_voxels^(1/2)
    double reach = 0;      ///< radius of the widened support, voxels
    glm::dvec2 centre{0};  ///< the voxel's centre in the picture, pixels from its upper left corner
    double depth = 0;      ///< of the voxel's centre, mm

    double rho2(double rho2_of_ray, const glm::dvec2& at) const;
};

/// The matter of a voxel between the faces around it, in voxels: what its unwarped kernel is scaled by. Summed over the
/// layers behind a face it is the distance to that face. 1 without an edge.
double matter_of_voxel(const VoxelEdge& edge, const Footprints& footprints);

/// Filter of the splat `record` at index-space position x; share 0 where view.low_pass is 0.
PixelFilter pixel_filter(const View& view, const SplatRecord& record, const glm::dvec3& x,
                         const Footprints& footprints);

}  // namespace edgesplat::reference
