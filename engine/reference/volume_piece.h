// The part of a ray inside the volume. The volume's border cuts kernels as a face does (docs/method/5_draw.md, Faces).
#pragma once

#include <glm/glm.hpp>

namespace edgesplat::reference {

/// Interval of the ray, voxels from its origin; low > high if the ray misses the volume.
struct VolumePiece {
    double low = 0, high = 0;
    glm::dvec3 normal{0};      ///< of the border where the ray enters: outwards, unit, index space
    glm::dvec3 far_normal{0};  ///< of the border where the ray leaves
    /// The same interval, counted from another point of the ray. `eye`: the old origin, relative to that point.
    VolumePiece seen_from(double eye) const { return {low + eye, high + eye, normal, far_normal}; }
};

/// Interval of the ray from `from` along the unit vector `u`, index space.
VolumePiece piece_in_volume(const glm::ivec3& dims, const glm::dvec3& from, const glm::dvec3& u);

}  // namespace edgesplat::reference
