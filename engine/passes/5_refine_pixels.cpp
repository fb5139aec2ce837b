#include "engine/passes/5_refine_pixels.h"

namespace edgesplat::passes {

gpu::Specialization refine_constants(const DrawVariant& variant, std::uint32_t step) {
    const std::uint32_t across = shader::TILE / step;
    return {{shader::SPEC_STEP, step},
            {shader::SPEC_GROUP, across * across},
            {shader::SPEC_MIXED, variant.mixed ? 1U : 0U},
            {shader::SPEC_SURFACES, variant.surfaces ? 1U : 0U}};
}

void refine_pixels(gpu::Commands& commands, const DrawVariant& variant, std::uint64_t tiles, std::uint32_t step) {
    commands.dispatch("5_refine_pixels.comp", refine_constants(variant, step), 0, commands.groups_for(tiles, 1));
    commands.barrier();
}

}  // namespace edgesplat::passes
