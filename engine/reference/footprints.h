// One splat's kernel, at a point and along a ray: footprints/ behind the settings' choice of warp and mode.
#pragma once

#include <memory>

#include "engine/reference/1_estimate_edges.h"
#include "footprints/face.h"
#include "footprints/footprint_cache.h"
#include "footprints/footprint_integral.h"

namespace edgesplat::reference {

/// What the settings make of a voxel's edge. Lengths in voxels, index space; positions relative to the voxel centre.
class Footprints {
  public:
    /// Builds (or loads from the cache) the table where the mode needs one, which takes seconds.
    explicit Footprints(const Settings& settings);

    /// Whether the kernel is warped at all; otherwise the closed-form isotropic footprint holds in every mode.
    bool warped(const VoxelEdge& edge) const;

    /// Whether an edge is drawn at all and its band reaches the kernel, walls too thin to be warped included.
    bool near_edge(const VoxelEdge& edge) const;

    /// h at the point r: K of the warped position.
    double at_point(const VoxelEdge& edge, const glm::dvec3& r) const;

    /// Integral of h along the line p + z u in the settings' footprint mode; p the line's point nearest to the voxel,
    /// u a unit vector.
    double along_ray(const VoxelEdge& edge, const glm::dvec3& p, const glm::dvec3& u) const;

    /// The same over a piece of the line.
    double along_slice(const VoxelEdge& edge, const glm::dvec3& p, const glm::dvec3& u, const Slice& slice) const;

    /// Whether the kernel is cut at a face, and how its ray, or a piece of it, then sees it.
    bool cuts(const VoxelEdge& edge) const;
    FaceFootprint at_face(const VoxelEdge& edge, const glm::dvec3& p, const glm::dvec3& u, const Slice& slice) const;

    /// Whether r, relative to the voxel centre, is inside the voxel's matter: in its kernel, and on the voxel's own
    /// side of its edge. (For the paper's family the kernel is taken as the ball that holds it.)
    bool in_matter(const VoxelEdge& edge, const glm::dvec3& r) const;

    /// Sphere around x + shift n outside which h is 0. A bound that holds for every edge of these settings, since the
    /// smallest sphere takes a search per edge; `warped_support` gives that one.
    Support support(const VoxelEdge& edge) const;

    /// How far from its voxel a kernel of these settings can be anything but 0, voxels.
    double farthest_reach() const { return largest_radius_; }

  private:
    Edge faces(const VoxelEdge& edge) const;  ///< edge family, with the rule for thin walls
    bool is_wall(const VoxelEdge& edge) const;

    Settings settings_;
    EdgeBand band_;
    double largest_radius_;  ///< of any warped kernel, voxels
    std::shared_ptr<const FootprintTable> table_;
};

}  // namespace edgesplat::reference
