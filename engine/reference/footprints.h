// The kernel of a splat, at a point and along a ray, by the settings' warp and footprint mode (footprints/).
#pragma once

#include <utility>

#include "engine/reference/1_estimate_edges.h"
#include "engine/scene/settings.h"
#include "footprints/face.h"
#include "footprints/footprint_integral.h"
#include "footprints/footprint_table.h"

namespace edgesplat::reference {

/// Kernels and footprints for one choice of settings. Lengths in voxels, index space; positions relative to the voxel
/// centre.
class Footprints {
  public:
    /// `table_depth`: FaceCut::depth of the faces in the table, voxels.
    explicit Footprints(const Settings& settings, double table_depth = FACE_DEPTH,
                        FacePieces pieces = FacePieces::Both);

    /// The kernel that is warped or cut: the narrow one if faces cut it and all matter is opaque.
    const Kernel& kernel() const;

    /// Whether the kernel is warped or cut. If not, its footprint is the closed-form isotropic one in every mode.
    bool warped(const VoxelEdge& edge) const;

    /// h at the point r: K of the warped position.
    double at_point(const VoxelEdge& edge, const glm::dvec3& r) const;

    /// Integral of h along the line p + z u in the settings' footprint mode; p the line's point nearest to the voxel,
    /// u a unit vector.
    double along_ray(const VoxelEdge& edge, const glm::dvec3& p, const glm::dvec3& u) const;

    /// The same over a piece of the line.
    double along_slice(const VoxelEdge& edge, const glm::dvec3& p, const glm::dvec3& u, const Slice& slice) const;

    /// Whether a face cuts the kernel.
    bool cuts(const VoxelEdge& edge) const;
    /// The parts of the cut kernel along a ray.
    FacePath face_path(const VoxelEdge& edge, const glm::dvec3& p, const glm::dvec3& u) const;
    /// Whether light falls on both ends of the ray's path: in translucent matter, if both pieces count.
    bool lit_in_depth(const VoxelEdge& edge) const { return edge.deepest != FACE_DEPTH && pieces_ == FacePieces::Both; }
    /// Integral of the cut kernel over a piece of the ray, and the ends of the ray's path through its matter.
    FaceFootprint at_face(const VoxelEdge& edge, const glm::dvec3& p, const glm::dvec3& u, const Slice& slice) const;

    /// Whether the table has the kernel's footprint: whole kernels, plain or cut at one face.
    bool tabulated(const VoxelEdge& edge) const;
    /// Its layers for rays along `to_voxel`, and the layers' x axis (unit, across the ray; 0 for a plain kernel).
    std::pair<FootprintLayer, glm::dvec3> select(const VoxelEdge& edge, const glm::dvec3& to_voxel) const;
    double table_value(const FootprintLayer& layer, const glm::dvec3& axis, const glm::dvec3& p) const;

    /// Whether the ray's point p + z u, as in `along_ray`, lies in the voxel's matter: in its kernel and on the voxel's
    /// own side of its edge. (`paper`: the kernel counts as the ball that encloses it.)
    bool in_matter(const VoxelEdge& edge, const glm::dvec3& p, const glm::dvec3& u, double z) const;

    /// Distance from the voxel beyond which h is 0, voxels.
    double reach(const VoxelEdge& edge) const;

    /// The largest reach of any kernel with these settings, voxels.
    double farthest_reach() const { return kernel_reach(settings_); }

  private:
    Settings settings_;
    double table_depth_;
    FacePieces pieces_;
};

}  // namespace edgesplat::reference
