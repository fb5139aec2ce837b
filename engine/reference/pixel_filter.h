// Antialiasing of splats smaller than a pixel (docs/method/smoothing.md).
#pragma once

#include "engine/reference/2_collect_splats.h"
#include "engine/reference/footprints.h"

namespace edgesplat::reference {

struct View;

/// How a splat's footprint is widened to a pixel: |p|^2 = rho2 of a ray becomes of_pixels * (distance from the voxel's
/// image, pixels)^2 + of_voxels * rho2.
struct PixelFilter {
    double share = 0;      ///< weight of the widened footprint, [0, 1]
    double of_pixels = 0;  ///< det A / det(1 + A), A the form of the pixel's sides across the ray, voxels
    double of_voxels = 1;  ///< 1 / det(1 + A)
    double amplitude = 1;  ///< factor on the kernel: matter_of_voxel times of_voxels^(1/2)
    double reach = 0;      ///< radius of the widened support, voxels
    glm::dvec2 centre{0};  ///< image of the voxel's centre, pixels from the picture's upper left corner
    double depth = 0;      ///< of the voxel's centre, mm

    double rho2(double rho2_of_ray, const glm::dvec2& at) const;
};

/// The matter of a voxel between the faces around it, in voxels: the factor on its unwarped kernel. Its sum over the
/// layers behind a face is the distance to that face. 1 without an edge.
double matter_of_voxel(const VoxelEdge& edge, const Footprints& footprints);

/// Filter of the splat `record` at index-space position x. `share` is 0 if view.low_pass is 0.
PixelFilter pixel_filter(const View& view, const SplatRecord& record, const glm::dvec3& x,
                         const Footprints& footprints);

}  // namespace edgesplat::reference
