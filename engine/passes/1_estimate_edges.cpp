#include "engine/passes/1_estimate_edges.h"

namespace edgesplat::passes {
gpu::Specialization mark_constants(std::uint32_t axis, std::uint32_t iso_count, const ClipCount& clip) {
    return {{shader::SPEC_AXIS, axis},
            {shader::SPEC_ISO_COUNT, iso_count},
            {shader::SPEC_CLIP_KEEP, clip.keep},
            {shader::SPEC_CLIP_REMOVE, clip.remove}};
}

void mark_buried(gpu::Commands& commands, const glm::ivec3& dims, std::uint32_t iso_count, const ClipCount& clip) {
    const glm::uvec3 n(dims);
    const std::uint32_t lines[3] = {n.y * n.z, n.x * n.z, n.x * n.y};
    for (std::uint32_t axis = 0; axis < 3; ++axis) {
        commands.dispatch("1a_mark_buried.comp", mark_constants(axis, iso_count, clip), 0,
                          commands.groups_for(lines[axis], 64));
        commands.barrier();
    }
}

gpu::Specialization estimate_constants(const EstimateEdges& in) {
    return {{shader::SPEC_ESTIMATOR, static_cast<std::uint32_t>(in.estimator)},
            {shader::SPEC_BURIED, in.skip_buried ? 1 : 0},
            {shader::SPEC_ISO_COUNT, in.iso_count},
            {shader::SPEC_SURFACES, in.surfaces ? 1 : 0}};
}

void estimate_edges(gpu::Commands& commands, const EdgeRegion& region, const EstimateEdges& in) {
    const glm::ivec3 low = glm::max(region.core_low - shader::ESTIMATE_MARGIN, 0);
    const glm::ivec3 high = glm::min(region.core_low + region.core_size + shader::ESTIMATE_MARGIN, region.dims);
    const glm::uvec3 bricks = (glm::uvec3(high - low) + 7U) / 8U;
    const std::uint64_t count = region.bricks > 0 ? region.bricks : std::uint64_t{bricks.x} * bricks.y * bricks.z;
    commands.dispatch("1b_estimate_edges.comp", estimate_constants(in), 0, commands.groups_for(count, 1));
    commands.barrier();
}

}  // namespace edgesplat::passes
