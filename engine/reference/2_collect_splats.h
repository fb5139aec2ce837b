// Pass 2: the list of voxels that can be seen (method.md, 2_collect_splats).
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "engine/reference/1_estimate_edges.h"

namespace edgesplat::reference {

struct SplatRecord {
    std::uint32_t voxel = 0;     ///< linear index, x fastest
    std::uint32_t material = 0;  ///< index into Scene::materials
    VoxelEdge edge;
};

/// How far around a voxel everything must be opaque for it to be buried, per scene and grid; nothing where no voxel
/// can be buried. Depends on Settings::cull_buried and the materials; the eye is judged by `collect_splats`.
struct BuryRule {
    int distance = 0;          ///< r, voxels, 1..10
    std::vector<bool> opaque;  ///< per material
};
std::optional<BuryRule> bury_rule(const Scene& scene, const VolumeGeometry& geometry, const Settings& settings);

/// The visible voxels in ascending linear order. `edges` has one entry per voxel; `eye` is in world mm; with `for_tau`
/// nothing is buried.
std::vector<SplatRecord> collect_splats(const Field& field, const ScaledScene& scaled,
                                        const std::vector<VoxelEdge>& edges, const Scene& scene,
                                        const VolumeGeometry& geometry, const Settings& settings, const glm::dvec3& eye,
                                        bool for_tau = false);

}  // namespace edgesplat::reference
