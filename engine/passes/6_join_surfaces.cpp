#include "engine/passes/6_join_surfaces.h"

namespace edgesplat::passes {

void join_surfaces(gpu::Commands& commands, const glm::ivec2& size) {
    const glm::uvec2 groups = (glm::uvec2(size) + 7U) / 8U;
    commands.dispatch("6_join_surfaces.comp", {}, 0, {groups.x, groups.y});
    commands.barrier();
}

}  // namespace edgesplat::passes
