// Plane faces: the footprint of a kernel that they cut depends on only three numbers of the ray.
#pragma once

#include "footprints/face.h"

namespace edgesplat {

/// The values of a plane face, `distance` voxels from the voxel's centre along n, along a ray.
inline FaceRay plane_face(const Ray& ray, double distance) {
    return {ray.rho2, {ray.pn - distance, ray.un, 0}, {1, 0, 0}, ray.pn, 0};
}

/// How that face cuts the kernel.
inline FaceCut plane_cut(double distance) {
    return face_cut(distance, 0, 0, FACE_NOWHERE);
}

}  // namespace edgesplat
