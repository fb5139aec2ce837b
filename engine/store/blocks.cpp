#include "engine/store/blocks.h"

#include <algorithm>
#include <limits>

#include "engine/volume/filters.h"

namespace edgesplat {
namespace {

constexpr int kBorder = shader::BLOCK_BORDER;

/// Bit mask of all materials from that of range.low to that of range.high.
std::uint32_t materials_between(const shader::SceneParams& params, const ValueRange& range, const Volume& volume) {
    const auto material = [&](float value) {
        return material_of(params.iso, static_cast<float>(scaled_value(volume, static_cast<double>(value))));
    };
    std::uint32_t mask = 0;
    for (std::uint32_t m = material(range.low); m <= material(range.high); ++m)
        mask |= 1U << m;
    return mask;
}

/// Calls body for each of the eight corners of a box.
template <typename Body>
void for_corners(const glm::dvec3& low, const glm::dvec3& high, const Body& body) {
    for (int corner = 0; corner < 8; ++corner)
        body(glm::mix(low, high, glm::bvec3((corner & 1) != 0, (corner & 2) != 0, (corner & 4) != 0)));
}

}  // namespace

CollectionBlock largest_block(const glm::ivec3& dims) {
    const glm::ivec3 core = glm::min(dims, kBlockCore);
    return {glm::ivec3(0), glm::min(dims, kBlockCore + 2 * kBorder), glm::ivec3(0), core};
}

std::vector<CollectionBlock> blocks_with_splats(const SampleSource& source, const Volume& volume,
                                                const CollectionPlan& plan) {
    std::vector<CollectionBlock> blocks;
    const auto& params = plan.params;
    const glm::ivec3 dims = plan.dims, count = (dims + kBlockCore - 1) / kBlockCore;
    glm::ivec3 at;
    for (at.z = 0; at.z < count.z; ++at.z)
        for (at.y = 0; at.y < count.y; ++at.y)
            for (at.x = 0; at.x < count.x; ++at.x) {
                CollectionBlock block;
                block.core_low = at * kBlockCore;
                block.core_size = glm::min(glm::ivec3(kBlockCore), dims - block.core_low);
                block.low = glm::max(block.core_low - kBorder, 0);
                block.size = glm::min(block.core_low + block.core_size + kBorder, dims) - block.low;
                const std::uint32_t inside =
                    materials_between(params, source.range(block.core_low, block.core_size), volume);
                // Voxels up to two voxels beside translucent matter emit splats of it, too.
                const glm::ivec3 beside_low = glm::max(block.core_low - 2, 0);
                const glm::ivec3 beside = glm::min(block.core_low + block.core_size + 2, dims) - beside_low;
                const std::uint32_t around = params.translucent_mask == 0
                                                 ? 0
                                                 : materials_between(params, source.range(beside_low, beside), volume);
                if ((inside & params.visible_mask) == 0 && (around & params.translucent_mask) == 0) continue;
                // Outside the volume nothing is opaque, and clipped voxels occlude nothing.
                const glm::ivec3 buried_low = block.core_low - params.bury_distance;
                const glm::ivec3 buried = block.core_size + 2 * params.bury_distance;
                const bool within = glm::all(glm::greaterThanEqual(buried_low, glm::ivec3(0))) &&
                                    glm::all(glm::lessThanEqual(buried_low + buried, dims));
                if (plan.buried && !plan.clip.any() && within) {
                    const ValueRange range = source.range(buried_low, buried);
                    if (range.complete && (materials_between(params, range, volume) & ~params.opaque_mask) == 0)
                        continue;
                }
                blocks.push_back(block);
            }
    return blocks;
}

int countable_level(const VolumeGeometry& geometry, int levels, int finest) {
    constexpr std::uint64_t kMost = std::uint64_t{1} << (8 * sizeof(shader::Splat::voxel));
    int level = finest;
    while (level < levels && level_geometry(geometry, level).voxel_count() > kMost)
        ++level;
    return level;
}

int level_for(const VolumeGeometry& geometry, int levels, const Camera& camera, const glm::ivec2& size, double pixels) {
    if (!(pixels > 0)) return 0;
    const CameraFrame view = camera_frame(camera);
    double nearest = std::numeric_limits<double>::max();
    for_corners(glm::dvec3(0), glm::dvec3(geometry.dims - 1), [&](const glm::dvec3& corner) {
        nearest = std::min(nearest, glm::dot(view.forward, geometry.to_world(corner) - view.eye));
    });
    if (!(nearest > 0)) return 0;
    const auto spacing = geometry.spacing();
    double width = std::max({spacing.x, spacing.y, spacing.z}) * size.y / (2 * view.tan_half_y * nearest);
    int level = 0;
    for (; level + 1 < levels && 2 * width <= pixels; ++level)
        width *= 2;
    return level;
}

}  // namespace edgesplat
