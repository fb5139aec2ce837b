// Plane faces: the kernels that they cut depend on no more of a ray than three numbers.
#pragma once

#include "footprints/face.h"

namespace edgesplat {

/// What a ray sees of a plane face `distance` voxels from the voxel's centre along n.
inline FaceRay plane_face(const Ray& ray, double distance) {
    return {ray.rho2, {ray.pn - distance, ray.un, 0}, {1, 0, 0}, ray.pn, 0};
}

/// How it cuts the kernel.
inline FaceCut plane_cut(double distance) {
    return face_cut(distance, 0, 0, std::numeric_limits<double>::infinity());
}

}  // namespace edgesplat
