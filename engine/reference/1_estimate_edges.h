// Pass 1: the plane of the nearest edge of every voxel (method.md, 1_estimate_edges).
#pragma once

#include <limits>
#include <span>
#include <vector>

#include "engine/reference/field.h"
#include "engine/scene/settings.h"

namespace edgesplat::reference {

constexpr double kEdgeReach = 3.0;          ///< voxels, how far an edge is searched
constexpr double kSmallestGradient = 1e-3;  ///< G_MIN, of the value range per voxel

/// What a voxel knows about its nearest edge. Lengths in voxels, index space.
struct VoxelEdge {
    glm::dvec3 n{0};  ///< unit, from the voxel's own side across the edge; without an edge along -gradient
    double D = 0;     ///< distance to the edge along n; -0.5 .. R + a
    double D2 = std::numeric_limits<double>::infinity();  ///< distance along -n to the second edge
    double curvature =
        0;  ///< of the edge where it is drawn curved, 1/voxel, positive where n points away from its centre
    glm::dmat3 bending{0};  ///< of a face: second derivatives of its quadric, 1/voxel, symmetric
    double weight = 1;      ///< of the kernel, where kernels are normalised
    bool has_normal = false;
    bool has_edge = false;
    bool border = false;   ///< of a point of the surface: the volume ends there
    bool mixed = false;    ///< of a face: what faces the other way is the other end of the interval
    bool upper = false;    ///< the edge is the upper end of the voxel's interval
    bool adopted = false;  ///< the plane is a neighbour's
};

/// First dispatch: each voxel on its own. An edge farther than R + a is still there, for neighbours to adopt.
std::vector<VoxelEdge> estimate_own_edges(const Field& field, const ScaledScene& scene, const Settings& settings);

/// Second dispatch: adoption (march and cubic only).
std::vector<VoxelEdge> adopt_edges(const Field& field, const ScaledScene& scene, const Settings& settings,
                                   const std::vector<VoxelEdge>& own);

/// The weight of each kernel (`VoxelEdge::weight`) that makes the kernels around a voxel sum to one where its own is
/// largest. Edges as estimated, on both sides of every iso-value; before step 5.
void weigh_kernels(const Field& field, const Settings& settings, std::vector<VoxelEdge>& edges);

/// The weight of each kernel by its distance to the edge, smoothed, and what is drawn beyond: `contrasts` has one entry
/// per voxel, 0 where the matter across the edge is as dense.
void weigh_by_edge(const Settings& settings, std::span<const double> contrasts, std::vector<VoxelEdge>& edges);

/// Step 5: distances smoothed along the surface (march and cubic only), then edges that cannot matter are dropped. On
/// the device this happens on the way into the splat list.
std::vector<VoxelEdge> smooth_edges(const Field& field, const ScaledScene& scene, const Settings& settings,
                                    const std::vector<VoxelEdge>& edges);

/// Both dispatches. (dims.z, dims.y, dims.x) edges, in double; with `quantised`, what each dispatch stores goes
/// through `quantise`, as on the GPU.
std::vector<VoxelEdge> estimate_edges(const Field& field, const ScaledScene& scene, const Settings& settings,
                                      bool quantised = false);

/// The edge after its way through the 64 stored bits.
VoxelEdge quantise(const VoxelEdge& edge);

}  // namespace edgesplat::reference
