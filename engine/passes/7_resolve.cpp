#include "engine/passes/7_resolve.h"

namespace edgesplat::passes {

gpu::Specialization resolve_constants(const DrawVariant& variant, bool gradient) {
    return {{shader::SPEC_PAYLOAD, variant.payload},
            {shader::SPEC_GRADIENT, gradient ? 1U : 0U},
            {shader::SPEC_TILES, variant.tiles ? 1U : 0U},
            {shader::SPEC_OUTLINES, variant.outlines ? 1U : 0U}};
}

void resolve(gpu::Commands& commands, const DrawVariant& variant, const glm::ivec2& size, bool gradient) {
    const glm::uvec2 groups = (glm::uvec2(size) + 7U) / 8U;
    commands.dispatch("7_resolve.comp", resolve_constants(variant, gradient), 0, {groups.x, groups.y});
    commands.barrier();
}

}  // namespace edgesplat::passes
