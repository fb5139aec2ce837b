// Creases: up to three planes that bound the matter beside a voxel, if no single quadric fits the surface
// (docs/method/faces.md, 7). Lengths are voxels, index space.
#pragma once

#include <array>
#include <span>

#include "engine/reference/1_estimate_edges.h"

namespace edgesplat::reference {

/// A surface point that some voxel found, relative to another voxel.
struct Surfel {
    glm::dvec3 at{0};  ///< relative to the voxel
    glm::dvec3 n{0};   ///< out of the voxel's material
    bool upper = false;
    bool border = false;  ///< on the volume's border
};

/// Planes that bound the matter, which is where n . x < D for all of them. The nearest comes first.
struct CreasePlanes {
    int count = 0;
    std::array<VoxelEdge::Crease, 3> planes;
    /// Distance of a point outside the planes; negative inside.
    double off(const glm::dvec3& r) const;
};

/// Planes fitted to the surfels around `nearest` at the same end of the material's interval. None unless two directions
/// differ and each plane lies inside the others. Of samples with two values: the spline has rounded sharp creases.
CreasePlanes crease_planes(std::span<const Surfel> surfels, const Surfel& nearest);

/// The third plane of a corner, if it is perpendicular to the first two and passes in front of the voxel; else none.
VoxelEdge::Crease corner_of(const CreasePlanes& planes);
/// The plane at `distance` that is perpendicular to both; `turned`: its normal is against their cross product.
VoxelEdge::Crease square_to(const glm::dvec3& n, const glm::dvec3& crease, double distance, bool turned);

}  // namespace edgesplat::reference
