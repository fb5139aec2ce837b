#include "engine/passes/1_estimate_edges.h"

namespace edgesplat::passes {
namespace {

/// A workgroup a brick of 8^3 (shaders/lib/brick_list.glsl).
gpu::Groups brick_groups(const EdgeRegion& region, int margin) {
    const glm::ivec3 low = glm::max(region.core_low - margin, 0);
    const glm::ivec3 high = glm::min(region.core_low + region.core_size + margin, region.dims);
    const glm::uvec3 groups = (glm::uvec3(high - low) + 7U) / 8U;
    return {groups.x, groups.y, groups.z};
}

}  // namespace

void mark_buried(gpu::Commands& commands, const glm::ivec3& dims, const ClipCount& clip) {
    const glm::uvec3 n(dims);
    const std::uint32_t lines[3] = {n.y * n.z, n.x * n.z, n.x * n.y};
    for (std::uint32_t axis = 0; axis < 3; ++axis) {
        commands.dispatch(
            "1a_mark_buried.comp",
            {{shader::SPEC_AXIS, axis}, {shader::SPEC_CLIP_KEEP, clip.keep}, {shader::SPEC_CLIP_REMOVE, clip.remove}},
            0, gpu::groups_for(lines[axis], 64));
        commands.barrier();
    }
}

gpu::Specialization estimate_constants(EdgeEstimator estimator, bool skip_buried) {
    return {{shader::SPEC_ESTIMATOR, static_cast<std::uint32_t>(estimator)},
            {shader::SPEC_BURIED, skip_buried ? 1 : 0}};
}

void estimate_edges(gpu::Commands& commands, const EdgeRegion& region, EdgeEstimator estimator, bool skip_buried) {
    commands.dispatch("1b_estimate_edges.comp", estimate_constants(estimator, skip_buried), 0,
                      brick_groups(region, shader::ESTIMATE_MARGIN));
    commands.barrier();
    if (estimator != EdgeEstimator::March && estimator != EdgeEstimator::Cubic) return;
    commands.dispatch("1c_adopt_edges.comp", {{shader::SPEC_BURIED, skip_buried ? 1 : 0}}, 0,
                      brick_groups(region, shader::ADOPT_MARGIN));
    commands.barrier();
}

}  // namespace edgesplat::passes
