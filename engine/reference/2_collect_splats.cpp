#include "engine/reference/2_collect_splats.h"

#include <algorithm>
#include <cmath>

#include "engine/reference/field_geometry.h"
#include "engine/scene/clip_planes.h"
#include "engine/scene/transfer_function.h"
#include "engine/volume/grid.h"
#include "engine/volume/labels.h"
#include "engine/volume/parallel.h"
#include "shaders/shared/limits.h"

namespace edgesplat::reference {

namespace {

/// 1 if every voxel of the cube [-r, r]^3 lies in the volume and is opaque, else 0. Computed one axis at a time.
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
    const double step = shortest_spacing(geometry);
    const double radius = uncut_kernel(settings, scene, geometry).radius;
    BuryRule rule;
    double distance = 0;
    for (std::size_t m = 0; m < scene.materials.size(); ++m) {
        const double depth = extinctions_of(scene, m).least * step;
        rule.opaque.push_back(depth >= 0.75);
        if (rule.opaque.back()) distance = std::max(distance, std::ceil(radius + std::log(256.0) / depth));
    }
    if (distance == 0 || distance > 10) return std::nullopt;
    rule.distance = static_cast<int>(distance);
    return rule;
}

double border_weight(const Field& field, const ScaledScene& scene, const Settings& settings, const glm::ivec3& i,
                     int m) {
    double weight = 1;
    if (!draws_faces(settings) || !scene.is_translucent[static_cast<std::size_t>(m)]) return weight;
    for (int axis = 0; axis < 3; ++axis)
        for (const int outermost : {0, field.dims[axis] - 1})
            if (i[axis] == outermost) weight *= static_cast<double>(shader::BORDER_WEIGHT);
    return weight;
}

std::vector<double> classified_values(const Field& field, const ScaledScene& scaled,
                                      const std::vector<VoxelEdge>& edges) {
    std::vector<double> values(field.values.begin(), field.values.end());
    geometry::FieldGeometry samples(field, scaled);
    for (std::size_t at = 0; at < values.size(); ++at)
        values[at] = samples.classified_value(field.voxel(at), values[at], samples.material_of(values[at]),
                                              geometry::edge_of(edges[at]));
    return values;
}

double carried_value(const Field& field, const ScaledScene& scaled, const std::vector<VoxelEdge>& edges,
                     const CarriedEdge& carried) {
    geometry::FieldGeometry samples(field, scaled);
    const glm::ivec3 i = field.voxel(carried.voxel);
    return samples.carried_value(i, samples.material_at(i), static_cast<std::uint32_t>(carried.material),
                                 geometry::edge_of(edges[carried.voxel]));
}

std::optional<TransferPoint> labelled(const Field& field, const ScaledScene& scaled, const Scene& scene,
                                      std::size_t voxel, int material) {
    if (!scaled.labels || material == 0) return std::nullopt;
    const std::uint32_t label = label_near(*scaled.labels, field.dims, field.voxel(voxel));
    const Material& matter = scene.materials[static_cast<std::size_t>(material)];
    return TransferPoint{0, label == 0 ? matter.color : scene.label_colors[label - 1], matter.extinction};
}

std::vector<SplatRecord> collect_splats(const Field& field, const ScaledScene& scaled,
                                        const std::vector<VoxelEdge>& edges, const Scene& scene,
                                        const VolumeGeometry& geometry, const Settings& settings, const glm::dvec3& eye,
                                        bool for_tau, std::span<const double> values,
                                        std::span<const CarriedEdge> carried) {
    std::optional<BuryRule> rule = for_tau ? std::nullopt : bury_rule(scene, geometry, settings);
    std::vector<char> opaque(field.values.size(), 0);
    const IndexClip clip = index_clip(scene.effects.clip, geometry);
    if (rule) {
        for (std::size_t at = 0; at < opaque.size(); ++at) {
            const int m = scaled.material(static_cast<double>(field.values[at]));
            const bool there = clip.empty() || !clip.cuts_away(glm::dvec3(field.voxel(at)));
            opaque[at] = there && field.has_data(at) && rule->opaque[static_cast<std::size_t>(m)] ? 1 : 0;
        }
        // An eye inside opaque matter sees buried voxels, so none is culled. The test uses doubles, since the voxel of
        // a far eye overflows an int.
        const glm::dvec3 nearest = glm::round(geometry.to_index(eye));
        const bool inside = glm::all(glm::greaterThanEqual(nearest, glm::dvec3(0))) &&
                            glm::all(glm::lessThan(nearest, glm::dvec3(field.dims)));
        const auto eye_material = [&] {
            return scaled.material(static_cast<double>(field.values[field.offset(glm::ivec3(nearest))]));
        };
        if (inside && !clip.cuts_away(geometry.to_index(eye)) && field.has_data(field.offset(glm::ivec3(nearest))) &&
            rule->opaque[static_cast<std::size_t>(eye_material())]) {
            rule.reset();
        }
    }
    const double reach = kernel_reach(settings);
    const std::vector<char> buried =
        rule ? buried_voxels(field, opaque, rule->distance) : std::vector<char>(opaque.size(), 0);

    std::vector<SplatRecord> records;
    for (std::size_t at = 0; at < edges.size(); ++at) {
        const int own = scaled.material(static_cast<double>(field.values[at]));
        const bool there = buried[at] == 0 && !(rule && clip.cuts_away(glm::dvec3(field.voxel(at)), reach));
        const auto add = [&](int m, const VoxelEdge& edge, double value) {
            SplatRecord record{static_cast<std::uint32_t>(at), static_cast<std::uint32_t>(m), edge};
            record.weight = border_weight(field, scaled, settings, field.voxel(at), m);
            record.classified =
                scaled.transfer.empty() ? labelled(field, scaled, scene, at, m) : transfer_at(scaled.transfer, value);
            if (there && (!record.classified || record.classified->extinction > 0)) records.push_back(record);
        };
        for (; !carried.empty() && carried.front().voxel == at && carried.front().material < own;
             carried = carried.subspan(1))
            add(carried.front().material, carried.front().edge, carried.front().value);
        if (field.has_data(at) && scaled.drawn[static_cast<std::size_t>(own)])
            add(own, edges[at], values.empty() ? 0 : values[at]);
        for (; !carried.empty() && carried.front().voxel == at; carried = carried.subspan(1))
            add(carried.front().material, carried.front().edge, carried.front().value);
    }
    return records;
}

}  // namespace edgesplat::reference
