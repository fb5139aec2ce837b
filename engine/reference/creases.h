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

/// Of the surfels around `nearest` that lie on the same end of the material's interval. None unless there are two
/// directions that differ, and each plane lies inside of the others. `sharp`: samples around have two values alone, and
/// what the spline rounds may be sharp.
CreasePlanes crease_planes(std::span<const Surfel> surfels, const Surfel& nearest, bool sharp);

/// The third plane of a corner, where it is square to the first two and passes in front of the voxel; else none.
VoxelEdge::Crease corner_of(const CreasePlanes& planes);
/// The plane at that distance that is square to both, `turned` against their cross product.
VoxelEdge::Crease square_to(const glm::dvec3& n, const glm::dvec3& crease, double distance, bool turned);

}  // namespace edgesplat::reference
