// What of a ray lies in the volume, whose border cuts kernels as a face does (method.md, 5_draw_splats, Faces).
#pragma once

#include <glm/glm.hpp>

namespace edgesplat::reference {

/// From the point that the ray comes from, voxels; low > high where it misses the volume.
struct VolumePiece {
    double low = 0, high = 0;
    glm::dvec3 normal{0};      ///< of the border where the ray enters, out of the volume; index space, unit
    glm::dvec3 far_normal{0};  ///< where it leaves
    /// Counted from a point that the eye lies `eye` from, along the ray.
    VolumePiece seen_from(double eye) const { return {low + eye, high + eye, normal, far_normal}; }
};

/// Of the ray from `from` along the unit vector `u`, index space.
VolumePiece piece_in_volume(const glm::ivec3& dims, const glm::dvec3& from, const glm::dvec3& u);

}  // namespace edgesplat::reference
