// Creases: up to three planes between which the matter beside a voxel lies, where no single quadric fits the surface
// (method.md, pass 2, creases). Lengths are voxels, index space.
#pragma once

#include <array>
#include <span>

#include "engine/reference/1_estimate_edges.h"

namespace edgesplat::reference {

/// A point of the surface that some voxel found, as another voxel sees it.
struct Surfel {
    glm::dvec3 at{0};  ///< relative to the voxel
    glm::dvec3 n{0};   ///< out of the voxel's material
    bool upper = false;
    bool border = false;  ///< of the volume
};

/// The matter where n . x < D for each of them, the nearest first.
struct CreasePlanes {
    int count = 0;
    std::array<VoxelEdge::Crease, 3> planes;
    /// How far a point lies outside; negative inside.
    double off(const glm::dvec3& r) const;
};

/// Of the surfels around `middle` that lie on that end of the material's interval; n: their normal there. None unless
/// there are two directions that differ, and each plane lies inside of the others.
CreasePlanes crease_planes(std::span<const Surfel> surfels, const glm::dvec3& middle, const glm::dvec3& n, bool upper);

}  // namespace edgesplat::reference
