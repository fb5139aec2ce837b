// Pass 1: finds the surface next to each voxel (docs/method/1_estimate_edges.md), and fits the face that pass 2 stores.
#pragma once

#include <limits>
#include <optional>
#include <vector>

#include "engine/reference/field.h"
#include "engine/scene/settings.h"
#include "footprints/face.h"

namespace edgesplat::reference {

constexpr double kSmallestGradient = 1e-3;  ///< G_MIN, of the value range per voxel

/// A voxel's nearest edge. Lengths in voxels, index space.
struct VoxelEdge {
    glm::dvec3 n{0};  ///< unit, from the voxel's own side across the edge; along -gradient if there is no edge
    double D = 0;     ///< distance to the edge along n
    double D2 = std::numeric_limits<double>::infinity();  ///< distance along -n to a wall's second face
    /// A further plane that bounds the matter: n . x = D, n out of the matter. D is infinite if there is none.
    struct Crease {
        glm::dvec3 n{0};
        double D = std::numeric_limits<double>::infinity();
    };
    Crease crease;          ///< second plane of a face
    Crease corner;          ///< third plane at a corner, perpendicular to both
    bool traced = false;    ///< of a surface splat: the face is refused, and rays find the surface
    glm::dmat3 bending{0};  ///< H of the face's quadric: second derivatives, 1/voxel, symmetric
    bool has_normal = false;
    bool has_edge = false;
    bool border = false;          ///< this surface point lies on the volume's border
    double deepest = FACE_DEPTH;  ///< upper bound of FaceCut::depth, voxels
    double steep = 0;             ///< of a face: weight of the field's own direction at the voxel, 0 to 1
    bool mixed = false;           ///< of a face: the opposite face is the other end of the interval
    bool upper = false;           ///< the edge is the upper end of the voxel's interval
};

/// The plane at `distance` that is perpendicular to both; `turned`: its normal is against their cross product.
VoxelEdge::Crease square_to(const glm::dvec3& n, const glm::dvec3& crease, double distance, bool turned);

/// The edge of a splat that a voxel emits for translucent matter beside it. The voxel itself lies outside that matter.
struct CarriedEdge {
    std::size_t voxel = 0;  ///< linear index, x fastest
    int material = 0;
    VoxelEdge edge;
    double value = 0;  ///< with a transfer function: the value that classifies the splat
};

/// For each voxel, the translucent materials other than its own within the range of the samples around it
/// (values_around). Edges are not set.
std::vector<CarriedEdge> voxels_beside(const Field& field, const ScaledScene& scene);

/// The surfel of voxel i, as an edge (n, D): the surface point, at most 1.25 voxels away, whose normal passes through
/// the voxel. Without one only a normal. Newton's method on the trilinear field, or with `cubic` on the spline.
VoxelEdge find_surfel(const Field& field, const ScaledScene& scene, const glm::ivec3& i, bool cubic);

/// One edge per voxel, (dims.z, dims.y, dims.x), double. `taylor` finds a plane; the others find the surface point
/// whose normal passes through the voxel. `quantised` rounds them by `quantise`, as on the GPU.
std::vector<VoxelEdge> estimate_edges(const Field& field, const ScaledScene& scene, const Settings& settings,
                                      bool quantised = false);

/// The face that cuts voxel i's kernel of material m. Without a face: the normal that lights the kernel. D =
/// CARRIES_NOTHING (limits.h) if the voxel lies outside the matter and its kernel does not reach it.
VoxelEdge finished_face(const Field& field, const ScaledScene& scene, const Settings& settings,
                        const std::vector<VoxelEdge>& edges, const glm::ivec3& i, int m);

/// The edges that splats are drawn with: faces fitted to `edges`, or `edges` unchanged with `paper`.
std::vector<VoxelEdge> finish_edges(const Field& field, const ScaledScene& scene, const Settings& settings,
                                    const std::vector<VoxelEdge>& edges);
/// The same for voxels beside translucent matter.
void finish_carried(const Field& field, const ScaledScene& scene, const Settings& settings,
                    const std::vector<VoxelEdge>& edges, std::vector<CarriedEdge>& carried);

/// The edge rounded to the bits that the GPU stores.
VoxelEdge quantise(const VoxelEdge& edge);

}  // namespace edgesplat::reference
