#include "engine/passes/6_join_surfaces.h"

namespace edgesplat::passes {

void join_surfaces(gpu::Commands& commands, const glm::ivec2& size) {
    const std::uint64_t pixels = static_cast<std::uint64_t>(size.x) * static_cast<std::uint64_t>(size.y);
    commands.dispatch("6_join_surfaces.comp", {}, 0, commands.groups_for(pixels, 64));
    commands.barrier();
}

}  // namespace edgesplat::passes
