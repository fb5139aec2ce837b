#include "engine/reference/2_collect_splats.h"

#include <algorithm>
#include <cmath>

#include "engine/reference/parallel.h"
#include "footprints/kernel.h"

namespace edgesplat::reference {

namespace {

double shortest_step(const VolumeGeometry& geometry) {
    const glm::dvec3 spacing = geometry.spacing();
    return std::min({spacing.x, spacing.y, spacing.z});
}

/// 1 where every voxel of the cube [-r, r]^3 lies in the volume and is opaque. Run lengths along one axis at a time.
std::vector<char> buried_voxels(const Field& field, const std::vector<char>& opaque, int r) {
    std::vector<char> all = opaque;
    for (int axis = 0; axis < 3; ++axis) {
        std::vector<char> next(all.size(), 0);
        for (std::size_t at = 0; at < all.size(); ++at) {
            const glm::ivec3 i = field.voxel(at);
            if (i[axis] - r < 0 || i[axis] + r >= field.dims[axis]) continue;
            bool full = true;
            for (int o = -r; o <= r && full; ++o) {
                glm::ivec3 j = i;
                j[axis] += o;
                full = all[field.offset(j)] != 0;
            }
            next[at] = full ? 1 : 0;
        }
        all = std::move(next);
    }
    return all;
}

}  // namespace

std::optional<BuryRule> bury_rule(const Scene& scene, const VolumeGeometry& geometry, const Settings& settings) {
    if (!settings.cull_buried) return std::nullopt;
    const double step = shortest_step(geometry);
    BuryRule rule;
    double distance = 0;
    for (const Material& material : scene.materials) {
        const double depth = material.extinction * step;
        rule.opaque.push_back(depth >= 0.75);
        if (rule.opaque.back()) distance = std::max(distance, std::ceil(kKernelRadius + std::log(256.0) / depth));
    }
    if (distance == 0 || distance > 10) return std::nullopt;
    rule.distance = static_cast<int>(distance);
    return rule;
}

std::vector<SplatRecord> collect_splats(const Field& field, const ScaledScene& scaled,
                                        const std::vector<VoxelEdge>& edges, const Scene& scene,
                                        const VolumeGeometry& geometry, const Settings& settings, const glm::dvec3& eye,
                                        bool for_tau) {
    std::optional<BuryRule> rule = for_tau ? std::nullopt : bury_rule(scene, geometry, settings);
    std::vector<char> opaque(field.values.size(), 0);
    if (rule) {
        for (std::size_t at = 0; at < opaque.size(); ++at) {
            const int m = scaled.material(static_cast<double>(field.values[at]));
            opaque[at] = rule->opaque[static_cast<std::size_t>(m)] ? 1 : 0;
        }
        // From inside opaque matter, what is buried is what is seen. Far outside, rounding would overflow an int.
        const glm::dvec3 nearest = glm::round(geometry.to_index(eye));
        const bool inside = glm::all(glm::greaterThanEqual(nearest, glm::dvec3(0))) &&
                            glm::all(glm::lessThan(nearest, glm::dvec3(field.dims)));
        if (inside && opaque[field.offset(glm::ivec3(nearest))] != 0) rule.reset();
    }
    const std::vector<char> buried =
        rule ? buried_voxels(field, opaque, rule->distance) : std::vector<char>(opaque.size(), 0);

    std::vector<SplatRecord> records;
    for (std::size_t at = 0; at < edges.size(); ++at) {
        const int m = scaled.material(static_cast<double>(field.values[at]));
        if (!scaled.drawn[static_cast<std::size_t>(m)] || buried[at] != 0) continue;
        records.push_back({static_cast<std::uint32_t>(at), static_cast<std::uint32_t>(m), edges[at]});
    }
    return records;
}

}  // namespace edgesplat::reference
