#include "engine/passes/1_estimate_edges.h"

namespace edgesplat::passes {
namespace {

gpu::Groups voxel_groups(const glm::ivec3& dims) {  // local size 8 x 4 x 2 in the shaders
    const glm::uvec3 groups = (glm::uvec3(dims) + glm::uvec3(7, 3, 1)) / glm::uvec3(8, 4, 2);
    return {groups.x, groups.y, groups.z};
}

}  // namespace

void estimate_edges(gpu::Commands& commands, shader::Address scene, const glm::ivec3& dims, EdgeEstimator estimator) {
    const shader::FramePush push{scene, 0, 0};
    const gpu::Specialization constants{{shader::SPEC_ESTIMATOR, static_cast<std::uint32_t>(estimator)}};
    commands.dispatch("1a_estimate_edges.comp", constants, push, voxel_groups(dims));
    commands.barrier();
    if (estimator != EdgeEstimator::March && estimator != EdgeEstimator::Cubic) return;
    commands.dispatch("1b_adopt_edges.comp", {}, push, voxel_groups(dims));
    commands.barrier();
}

}  // namespace edgesplat::passes
