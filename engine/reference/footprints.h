// One splat's kernel, at a point and along a ray: footprints/ behind the settings' choice of warp and mode.
#pragma once

#include <utility>

#include "engine/reference/1_estimate_edges.h"
#include "engine/scene/settings.h"
#include "footprints/face.h"
#include "footprints/footprint_integral.h"
#include "footprints/footprint_table.h"

namespace edgesplat::reference {

/// What the settings make of a voxel's edge. Lengths in voxels, index space; positions relative to the voxel centre.
class Footprints {
  public:
    /// `table_depth`: no deeper under faces that are in the table kernels are sampled, voxels.
    explicit Footprints(const Settings& settings, double table_depth = kFaceDepth,
                        FacePieces pieces = FacePieces::Both);

    /// What is warped, or cut: the narrow kernel where faces cut it and nothing is seen through.
    const Kernel& kernel() const;

    /// Whether the kernel is warped at all; otherwise the closed-form isotropic footprint holds in every mode.
    bool warped(const VoxelEdge& edge) const;

    /// h at the point r: K of the warped position.
    double at_point(const VoxelEdge& edge, const glm::dvec3& r) const;

    /// Integral of h along the line p + z u in the settings' footprint mode; p the line's point nearest to the voxel,
    /// u a unit vector.
    double along_ray(const VoxelEdge& edge, const glm::dvec3& p, const glm::dvec3& u) const;

    /// The same over a piece of the line.
    double along_slice(const VoxelEdge& edge, const glm::dvec3& p, const glm::dvec3& u, const Slice& slice) const;

    /// Whether the kernel is cut at a face, and how its ray, or a piece of it, then sees it.
    bool cuts(const VoxelEdge& edge) const;
    /// What a ray passes of it.
    FacePath face_path(const VoxelEdge& edge, const glm::dvec3& p, const glm::dvec3& u) const;
    /// Whether light falls in the depth of what a ray passes: where one sees through matter, and both pieces of it
    /// count.
    bool lit_in_depth(const VoxelEdge& edge) const { return edge.deepest != kFaceDepth && pieces_ == FacePieces::Both; }
    FaceFootprint at_face(const VoxelEdge& edge, const glm::dvec3& p, const glm::dvec3& u, const Slice& slice) const;

    /// Whether the table has it: whole kernels, plain or cut at one face. Then its layers, and the axis (unit, across
    /// the view; 0 of a plain kernel) that x lies along there, for rays along `to_voxel`.
    bool tabulated(const VoxelEdge& edge) const;
    std::pair<FootprintLayer, glm::dvec3> select(const VoxelEdge& edge, const glm::dvec3& to_voxel) const;
    double looked_up(const FootprintLayer& layer, const glm::dvec3& axis, const glm::dvec3& p) const;

    /// Whether the point p + z u of a ray, as in `along_ray`, is inside the voxel's matter: in its kernel, and on the
    /// voxel's own side of its edge. (With `paper` the kernel is taken as the ball that holds it.)
    bool in_matter(const VoxelEdge& edge, const glm::dvec3& p, const glm::dvec3& u, double z) const;

    /// How far from the voxel h can be anything but 0, voxels.
    double reach(const VoxelEdge& edge) const;

    /// How far from its voxel a kernel of these settings can be anything but 0, voxels.
    double farthest_reach() const { return kernel_reach(settings_); }

  private:
    Settings settings_;
    double table_depth_;
    FacePieces pieces_;
};

}  // namespace edgesplat::reference
