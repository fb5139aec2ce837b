// Faces: surface points beside voxels (surfels), the quadric fitted to those around a voxel, and its values along a ray
// (docs/method/faces.md). Lengths are voxels, index space.
#pragma once

#include <optional>

#include "engine/reference/1_estimate_edges.h"
#include "engine/reference/creases.h"
#include "engine/reference/quadrics.h"
#include "footprints/face.h"

namespace edgesplat::reference {

/// The surfel of voxel i, as an edge (n, D): the surface point, at most 1.25 voxels away, whose normal passes through
/// the voxel. Without one only a normal. Newton's method on the trilinear field, or with `cubic` on the spline.
VoxelEdge find_surfel(const Field& field, const ScaledScene& scene, const glm::ivec3& i, bool cubic);

/// The surfel of voxel j, relative to voxel i, if it bounds material m.
std::optional<Surfel> surfel_of(const Field& field, const ScaledScene& scene, const std::vector<VoxelEdge>& surfels,
                                const glm::ivec3& i, const glm::ivec3& j, int m);

/// A point of a quadric whose normal passes through a voxel.
struct Foot {
    glm::dvec3 at{0}, slope{0};
    bool real = false;  ///< false: the quadric has no surface in reach
};

/// That point, searched from `at`; positions are relative to the quadric's middle.
Foot foot_of(const Quadric& q, const glm::dvec3& voxel_at, glm::dvec3 at);

/// Smallest and largest sample around a voxel. The surface that the voxel finds passes between these samples.
std::pair<double, double> values_around(const Field& field, const glm::ivec3& i);

/// The smallest of those samples with data.
double least_data_around(const Field& field, const glm::ivec3& i);

/// The edge of voxel i without a surface in reach: only the normal along -gradient, if there is one.
VoxelEdge edge_with_normal_only(const Field& field, const glm::ivec3& i);

/// The face of material m next to voxel i, which belongs to m or lies beside it: n, D, D2 and H of the quadric that
/// best fits the surfels around the nearest one. Without a face in reach only a normal.
VoxelEdge fit_face(const Field& field, const ScaledScene& scene, const std::vector<VoxelEdge>& surfels,
                   const glm::ivec3& i, int m);

/// Bending of a face: the Frobenius norm of H, 1/voxel.
double norm_of(const glm::dmat3& bending);

/// H rounded to the 60 stored bits.
glm::dmat3 quantise_bending(const glm::dmat3& bending);

/// How the edge's face cuts its kernel. The edge must have a face.
FaceCut cut_of(const VoxelEdge& edge, const Kernel& kernel);

/// Whether the footprint table has the edge's face: one face without creases, bent so little that it counts as plane.
bool is_in_table(const VoxelEdge& edge, const Settings& settings);

/// The edge as the settings draw it: faces in the table are plane.
VoxelEdge drawn_edge(const VoxelEdge& edge, const Settings& settings);

/// The values of a face along the ray p + z u; p is the ray's point nearest to the voxel, relative to it.
struct FaceSight {
    FaceRay ray;
    glm::dvec3 slope{0};  ///< grad phi at p
    glm::dvec3 turn{0};   ///< change of grad phi along u, per voxel
    /// Normal at z, away from the voxel's own side, not of unit length.
    glm::dvec3 outward(double z, bool from_behind) const { return (from_behind ? -1.0 : 1.0) * (slope + z * turn); }
};
FaceSight face_sight(const VoxelEdge& edge, const glm::dvec3& p, const glm::dvec3& u);

}  // namespace edgesplat::reference
