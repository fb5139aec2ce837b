#include "engine/passes/5_draw_tiles.h"

namespace edgesplat::passes {

gpu::Specialization tile_constants(const DrawVariant& variant, TileDraw how) {
    gpu::Specialization constants = draw_constants(variant);
    constants.emplace_back(shader::SPEC_ROUNDS, how.rounds ? 1U : 0U);
    constants.emplace_back(shader::SPEC_COUNT, how.count ? 1U : 0U);
    constants.emplace_back(shader::SPEC_PREPARED, how.prepared ? 1U : 0U);
    return constants;
}

void draw_tiles(gpu::Commands& commands, const DrawVariant& variant, std::uint64_t tiles, TileDraw how,
                std::uint32_t round) {
    commands.dispatch("5_draw_tiles.comp", tile_constants(variant, how), round, gpu::groups_for(tiles, 1));
    commands.barrier();
}

}  // namespace edgesplat::passes
