#include "engine/passes/5_draw_tiles.h"

namespace edgesplat::passes {

gpu::Specialization tile_constants(const DrawVariant& variant, TileDraw how) {
    gpu::Specialization constants = draw_constants(variant);
    constants.emplace_back(shader::SPEC_ROUNDS, how.rounds ? 1U : 0U);
    constants.emplace_back(shader::SPEC_COUNT, how.count ? 1U : 0U);
    return constants;
}

void draw_tiles(gpu::Commands& commands, const DrawVariant& variant, const glm::ivec2& tiles, TileDraw how,
                std::uint32_t round) {
    const auto count = static_cast<std::uint64_t>(tiles.x) * static_cast<std::uint64_t>(tiles.y);
    commands.dispatch("5_draw_tiles.comp", tile_constants(variant, how), round, gpu::groups_for(count, 1));
    commands.barrier();
}

}  // namespace edgesplat::passes
