#include "engine/passes/7_resolve.h"

namespace edgesplat::passes {

void resolve(gpu::Commands& commands, const glm::ivec2& size, std::uint32_t payload, bool gradient) {
    const glm::uvec2 groups = (glm::uvec2(size) + 7U) / 8U;
    commands.dispatch("7_resolve.comp", {{shader::SPEC_PAYLOAD, payload}, {shader::SPEC_GRADIENT, gradient ? 1U : 0U}},
                      0, {groups.x, groups.y});
    commands.barrier();
}

}  // namespace edgesplat::passes
