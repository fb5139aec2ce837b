#include "engine/passes/5_draw_tiles.h"

namespace edgesplat::passes {

std::uint32_t tile_group(TileDraw how) {
    return how.refined ? how.profile->list_group : how.profile->tile_group;
}

gpu::Specialization tile_constants(const DrawVariant& variant, TileDraw how) {
    gpu::Specialization constants = draw_constants(variant);
    constants.emplace_back(shader::SPEC_ROUNDS, how.profile->rounds ? 1U : 0U);
    constants.emplace_back(shader::SPEC_COUNT, how.count ? 1U : 0U);
    constants.emplace_back(shader::SPEC_PREPARED, how.prepared ? 1U : 0U);
    constants.emplace_back(shader::SPEC_REFINED, how.refined ? 1U : 0U);
    constants.emplace_back(shader::SPEC_WIDE_MARKS, how.refined || how.wide_marks ? 1U : 0U);
    constants.emplace_back(shader::SPEC_GROUP, tile_group(how));
    constants.emplace_back(shader::SPEC_OUTLINES, variant.outlines ? 1U : 0U);
    return constants;
}

void draw_tiles(gpu::Commands& commands, const DrawVariant& variant, TileDraw how, const TileRound& round) {
    const std::uint32_t what = round.round | round.tile_groups << 20U | (round.first_pixels ? 1U << 31U : 0U);
    commands.dispatch("5_draw_tiles.comp", tile_constants(variant, how), what, gpu::groups_for(round.groups, 1));
    commands.barrier();
}

}  // namespace edgesplat::passes
