// Pass 2: collects the visible voxels into the splat list (docs/method/2_collect_splats.md).
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "engine/reference/1_estimate_edges.h"
#include "engine/reference/shading.h"

namespace edgesplat::reference {

struct SplatRecord {
    std::uint32_t voxel = 0;     ///< linear index, x fastest
    std::uint32_t material = 0;  ///< index into Scene::materials
    VoxelEdge edge;
    std::optional<TransferPoint>
        classified{};   ///< with a transfer function or labels: replaces the material's colour and extinction
    double weight = 1;  ///< factor on the kernel: above 1 next to the volume's border, beyond which there are no voxels
    /// The light that reaches the splat (passes 2b and 2d); `turned_ambient`: the ambient light at a wall's other face.
    Reach reach{};
    double turned_ambient = 1;
    Reach reach_at(bool turned) const { return turned ? Reach{turned_ambient, reach.lights} : reach; }
    double extinction(const Scene& scene) const {
        return weight * (classified ? classified->extinction : scene.materials[material].extinction);
    }
    glm::dvec3 color(const Scene& scene) const {
        return classified ? classified->color : scene.materials[material].color;
    }
};

/// Rule that decides which voxels of a scene and grid are buried: all voxels within `distance` are opaque. nullopt if
/// no voxel can be buried. Depends on Settings::cull_buried and the materials; `collect_splats` tests the eye.
struct BuryRule {
    int distance = 0;          ///< r, voxels, 1..10
    std::vector<bool> opaque;  ///< per material
};
std::optional<BuryRule> bury_rule(const Scene& scene, const VolumeGeometry& geometry, const Settings& settings);

/// SplatRecord::weight of voxel i for material m.
double border_weight(const Field& field, const ScaledScene& scene, const Settings& settings, const glm::ivec3& i,
                     int m);

/// The value that classifies each voxel (two-sided classification): its sample, or, if an edge is nearer than one
/// voxel, the value at least one voxel from the edge on the voxel's own side. `edges` are as estimated, not fitted.
std::vector<double> classified_values(const Field& field, const ScaledScene& scaled,
                                      const std::vector<VoxelEdge>& edges);
/// The value that classifies the splat of matter beside a voxel: the value one voxel behind the edge, else the middle
/// of the material's interval. For the lowest and highest material: the smallest or largest sample around.
double carried_value(const Field& field, const ScaledScene& scaled, const std::vector<VoxelEdge>& edges,
                     const CarriedEdge& carried);

/// The material's extinction with the colour of the voxel's label; nullopt without labels in their own colours.
std::optional<TransferPoint> labelled(const Field& field, const ScaledScene& scaled, const Scene& scene,
                                      std::size_t voxel, int material);

/// The splats in ascending order of voxel index, and of material within a voxel. `edges` has one entry per voxel; so
/// has `values` with a transfer function (classified_values). `carried`: splats of translucent matter at voxels outside
/// it. `eye`: world mm. `for_tau`: nothing is buried. Voxels that clip planes cut away are not opaque. If voxels can be
/// buried, splats that are cut away whole are not collected.
std::vector<SplatRecord> collect_splats(const Field& field, const ScaledScene& scaled,
                                        const std::vector<VoxelEdge>& edges, const Scene& scene,
                                        const VolumeGeometry& geometry, const Settings& settings, const glm::dvec3& eye,
                                        bool for_tau = false, std::span<const double> values = {},
                                        std::span<const CarriedEdge> carried = {});

}  // namespace edgesplat::reference
