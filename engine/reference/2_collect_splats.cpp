#include "engine/reference/2_collect_splats.h"

#include <algorithm>
#include <cmath>

#include "engine/reference/parallel.h"
#include "engine/scene/clip_planes.h"
#include "engine/scene/transfer_function.h"
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
    for (std::size_t m = 0; m < scene.materials.size(); ++m) {
        const double depth = extinctions_of(scene, m).least * step;
        rule.opaque.push_back(depth >= 0.75);
        if (rule.opaque.back()) distance = std::max(distance, std::ceil(kKernelRadius + std::log(256.0) / depth));
    }
    if (distance == 0 || distance > 10) return std::nullopt;
    rule.distance = static_cast<int>(distance);
    return rule;
}

std::vector<double> classified_values(const Field& field, const ScaledScene& scaled,
                                      const std::vector<VoxelEdge>& edges) {
    std::vector<double> values(field.values.begin(), field.values.end());
    for (std::size_t at = 0; at < values.size(); ++at) {
        const VoxelEdge& edge = edges[at];
        const double way = std::max(1.0, 1 - edge.D);
        if (!edge.has_edge || !(std::abs(edge.D) < 1) || !(way < edge.D2)) continue;
        const double further = sample(field, glm::dvec3(field.voxel(at)) - way * edge.n);
        if (scaled.material(further) == scaled.material(values[at])) values[at] = further;
    }
    return values;
}

std::vector<SplatRecord> collect_splats(const Field& field, const ScaledScene& scaled,
                                        const std::vector<VoxelEdge>& edges, const Scene& scene,
                                        const VolumeGeometry& geometry, const Settings& settings, const glm::dvec3& eye,
                                        bool for_tau, std::span<const double> values) {
    std::optional<BuryRule> rule = for_tau ? std::nullopt : bury_rule(scene, geometry, settings);
    std::vector<char> opaque(field.values.size(), 0);
    const IndexClip clip = index_clip(scene.effects.clip, geometry);
    if (rule) {
        for (std::size_t at = 0; at < opaque.size(); ++at) {
            const int m = scaled.material(static_cast<double>(field.values[at]));
            const bool there = clip.empty() || !clip.cuts_away(glm::dvec3(field.voxel(at)));
            opaque[at] = there && rule->opaque[static_cast<std::size_t>(m)] ? 1 : 0;
        }
        // From inside opaque matter, what is buried is what is seen. Far outside, rounding would overflow an int.
        const glm::dvec3 nearest = glm::round(geometry.to_index(eye));
        const bool inside = glm::all(glm::greaterThanEqual(nearest, glm::dvec3(0))) &&
                            glm::all(glm::lessThan(nearest, glm::dvec3(field.dims)));
        const auto eye_material = [&] {
            return scaled.material(static_cast<double>(field.values[field.offset(glm::ivec3(nearest))]));
        };
        if (inside && !clip.cuts_away(geometry.to_index(eye)) &&
            rule->opaque[static_cast<std::size_t>(eye_material())]) {
            rule.reset();
        }
    }
    const double reach = kernel_reach(settings);
    const std::vector<char> buried =
        rule ? buried_voxels(field, opaque, rule->distance) : std::vector<char>(opaque.size(), 0);

    std::vector<SplatRecord> records;
    for (std::size_t at = 0; at < edges.size(); ++at) {
        const int m = scaled.material(static_cast<double>(field.values[at]));
        if (!scaled.drawn[static_cast<std::size_t>(m)] || buried[at] != 0) continue;
        if (rule && clip.cuts_away(glm::dvec3(field.voxel(at)), reach)) continue;
        SplatRecord record{static_cast<std::uint32_t>(at), static_cast<std::uint32_t>(m), edges[at]};
        if (!scaled.transfer.empty()) {
            record.classified = transfer_at(scaled.transfer, values[at]);
            if (!(record.classified->extinction > 0)) continue;
        }
        records.push_back(record);
    }
    return records;
}

}  // namespace edgesplat::reference
