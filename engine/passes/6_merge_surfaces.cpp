#include "engine/passes/6_merge_surfaces.h"

namespace edgesplat::passes {

void merge_surfaces(gpu::Commands& commands, Merge how, const glm::ivec2& size) {
    const std::uint64_t pixels = static_cast<std::uint64_t>(size.x) * static_cast<std::uint64_t>(size.y);
    commands.dispatch("6_merge_surfaces.comp", {}, static_cast<std::uint32_t>(how), commands.groups_for(pixels, 64));
    commands.barrier();
}

}  // namespace edgesplat::passes
