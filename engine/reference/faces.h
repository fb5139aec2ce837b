// Faces: points of the surface beside voxels, the quadric that fits those around one, and what a ray sees of it
// (method.md, pass 1, faces). Lengths are voxels, index space.
#pragma once

#include "engine/reference/1_estimate_edges.h"
#include "footprints/face.h"

namespace edgesplat::reference {

/// The point of the surface that voxel i sees at right angles, at most 1.25 voxels away, as its edge (n, D); without
/// one a normal alone. By Newton's method on the trilinear field, or with `cubic` on the spline.
VoxelEdge find_surfel(const Field& field, const ScaledScene& scene, const glm::ivec3& i, bool cubic);

/// The least and the largest sample around a voxel: no surface that it finds passes between samples further off.
std::pair<double, double> values_around(const Field& field, const glm::ivec3& i);

/// Of voxel i without a surface in reach: along the gradient, where there is one.
VoxelEdge normal_alone(const Field& field, const glm::ivec3& i);

/// The face of material m next to voxel i, which is of it or lies beside it: n, D, D2 and second derivatives of the
/// quadric that fits the surfels around the nearest best. Without one in reach a normal alone.
VoxelEdge fit_face(const Field& field, const ScaledScene& scene, const std::vector<VoxelEdge>& surfels,
                   const glm::ivec3& i, int m);

/// How much a face bends: the Frobenius norm of its second derivatives.
double norm_of(const glm::dmat3& bending);

/// The second derivatives after their way through the 60 stored bits.
glm::dmat3 quantise_bending(const glm::dmat3& bending);

/// How the edge's face cuts its kernel; the edge has one.
FaceCut cut_of(const VoxelEdge& edge, const Kernel& kernel);

/// Whether the edge's face is as those of the table: one, and bent so little that it is taken for plane.
bool is_in_table(const VoxelEdge& edge, const Settings& settings);

/// The edge as the settings draw it: in the table faces are plane.
VoxelEdge drawn_edge(const VoxelEdge& edge, const Settings& settings);

/// What the ray p + z u sees of a face; p is its point nearest to the voxel, relative to it.
struct FaceSight {
    FaceRay ray;
    glm::dvec3 slope{0};  ///< grad phi at p
    glm::dvec3 turn{0};   ///< of it along u
    /// Away from the voxel's own side at z, not of unit length.
    glm::dvec3 outward(double z, bool from_behind) const { return (from_behind ? -1.0 : 1.0) * (slope + z * turn); }
};
FaceSight face_sight(const VoxelEdge& edge, const glm::dvec3& p, const glm::dvec3& u);

}  // namespace edgesplat::reference
