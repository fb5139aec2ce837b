#include "engine/passes/2c_sweep_light.h"

namespace edgesplat::passes {

void sweep_light(gpu::Commands& commands, const glm::ivec2& size, std::uint32_t group) {
    const glm::uvec2 groups = (glm::uvec2(size) + 7U) / 8U;
    commands.dispatch("2c_sweep_light.comp", {}, group, {groups.x, groups.y});
    commands.barrier();
}

void shadow_splats(gpu::Commands& commands, std::uint64_t splat_count, const ClipCount& clip, std::uint32_t channel) {
    commands.dispatch("2d_shadow_splats.comp",
                      {{shader::SPEC_CLIP_KEEP, clip.keep}, {shader::SPEC_CLIP_REMOVE, clip.remove}}, channel,
                      commands.groups_for(splat_count, 64));
    commands.barrier();
}

}  // namespace edgesplat::passes
