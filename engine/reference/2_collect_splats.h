// Pass 2: the list of voxels that can be seen (method.md, 2_collect_splats).
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "engine/reference/1_estimate_edges.h"

namespace edgesplat::reference {

struct SplatRecord {
    std::uint32_t voxel = 0;     ///< linear index, x fastest
    std::uint32_t material = 0;  ///< index into Scene::materials
    VoxelEdge edge;
    std::optional<TransferPoint>
        classified{};   ///< with a transfer function: what it has there, in place of the material
    double weight = 1;  ///< of its kernel: more beside the volume's border, beyond which no voxel carries matter
    double extinction(const Scene& scene) const {
        return weight * (classified ? classified->extinction : scene.materials[material].extinction);
    }
    glm::dvec3 color(const Scene& scene) const {
        return classified ? classified->color : scene.materials[material].color;
    }
};

/// How far around a voxel everything must be opaque for it to be buried, per scene and grid; nothing where no voxel
/// can be buried. Depends on Settings::cull_buried and the materials; the eye is judged by `collect_splats`.
struct BuryRule {
    int distance = 0;          ///< r, voxels, 1..10
    std::vector<bool> opaque;  ///< per material
};
std::optional<BuryRule> bury_rule(const Scene& scene, const VolumeGeometry& geometry, const Settings& settings);

/// SplatRecord::weight of voxel i.
double border_weight(const Field& field, const ScaledScene& scene, const Settings& settings, const glm::ivec3& i,
                     int m);

/// What each voxel is classified by (two-sided classification): its sample, or where an edge is nearer than a voxel the
/// value a voxel further on its own side. Edges as estimated.
std::vector<double> classified_values(const Field& field, const ScaledScene& scaled,
                                      const std::vector<VoxelEdge>& edges);
/// Of what a voxel beside matter carries: the value a voxel behind the edge, or the middle of the material's interval;
/// of an outermost one the outermost sample around.
double carried_value(const Field& field, const ScaledScene& scaled, const std::vector<VoxelEdge>& edges,
                     const CarriedEdge& carried);

/// The visible voxels, and those beside them, in ascending linear order, each one's materials likewise. `edges` has one
/// entry per voxel, `values` likewise with a transfer function (classified_values), `carried` what voxels beside matter
/// have of it; `eye` is in world mm; with `for_tau` nothing is buried. What the scene's clip planes cut away hides
/// nothing; where something may be buried, it is left out.
std::vector<SplatRecord> collect_splats(const Field& field, const ScaledScene& scaled,
                                        const std::vector<VoxelEdge>& edges, const Scene& scene,
                                        const VolumeGeometry& geometry, const Settings& settings, const glm::dvec3& eye,
                                        bool for_tau = false, std::span<const double> values = {},
                                        std::span<const CarriedEdge> carried = {});

}  // namespace edgesplat::reference
