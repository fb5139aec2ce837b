// Pass 1: where the surface next to every voxel is (method.md, 1_estimate_edges), and what pass 2 makes of it.
#pragma once

#include <limits>
#include <optional>
#include <vector>

#include "engine/reference/field.h"
#include "engine/scene/settings.h"
#include "footprints/face.h"

namespace edgesplat::reference {

constexpr double kSmallestGradient = 1e-3;  ///< G_MIN, of the value range per voxel

/// What a voxel knows about its nearest edge. Lengths in voxels, index space.
struct VoxelEdge {
    glm::dvec3 n{0};  ///< unit, from the voxel's own side across the edge; without an edge along -gradient
    double D = 0;     ///< distance to the edge along n
    double D2 = std::numeric_limits<double>::infinity();  ///< distance along -n to the second edge
    /// Another plane that ends the matter: n . x = D, n away from the matter.
    struct Crease {
        glm::dvec3 n{0};
        double D = std::numeric_limits<double>::infinity();
    };
    Crease crease;  ///< of a face
    Crease corner;  ///< of a crease: a third plane, square to both
    /// Values that are matter, half open.
    struct Interval {
        double low = 0, high = 0;
        bool holds(double value) const { return value >= low && value < high; }
    };
    std::optional<Interval> traced;  ///< no quadric fits: rays find the surface of this
    glm::dmat3 bending{0};           ///< of a face: second derivatives of its quadric, 1/voxel, symmetric
    bool has_normal = false;
    bool has_edge = false;
    bool border = false;          ///< of a point of the surface: the volume ends there
    double deepest = kFaceDepth;  ///< no deeper under its face its kernel is sampled
    double steep = 0;             ///< of a face: how much of the field's direction at the voxel is believed, 0 to 1
    bool mixed = false;           ///< of a face: what faces the other way is the other end of the interval
    bool upper = false;           ///< the edge is the upper end of the voxel's interval
};

/// What a voxel beside matter of another material carries of that, where one sees through it.
struct CarriedEdge {
    std::size_t voxel = 0;  ///< linear index, x fastest
    int material = 0;
    VoxelEdge edge;
    double value = 0;  ///< with a transfer function: what it is classified by
};

/// Those voxels and materials, without their edges: as far as samples around a voxel have materials on its far side.
std::vector<CarriedEdge> voxels_beside(const Field& field, const ScaledScene& scene);

/// What each voxel finds by itself, (dims.z, dims.y, dims.x) edges in double: a plane by `taylor`, else the point of
/// the surface that it sees at right angles. With `quantised`, they go through `quantise`, as on the GPU.
std::vector<VoxelEdge> estimate_edges(const Field& field, const ScaledScene& scene, const Settings& settings,
                                      bool quantised = false);

/// The face that cuts what voxel i has of material m, or what that is lit by without one; D = CARRIES_NOTHING
/// (limits.h) where it lies beside the matter and has nothing of it.
VoxelEdge finished_face(const Field& field, const ScaledScene& scene, const Settings& settings,
                        const std::vector<VoxelEdge>& edges, const glm::ivec3& i, int m);

/// What splats are drawn with: faces fitted to those, or with `paper` the same.
std::vector<VoxelEdge> finish_edges(const Field& field, const ScaledScene& scene, const Settings& settings,
                                    const std::vector<VoxelEdge>& edges);
/// The same for voxels beside matter.
void finish_carried(const Field& field, const ScaledScene& scene, const Settings& settings,
                    const std::vector<VoxelEdge>& edges, std::vector<CarriedEdge>& carried);

/// The edge after its way through the 64 stored bits.
VoxelEdge quantise(const VoxelEdge& edge);

}  // namespace edgesplat::reference
