#include "engine/passes/4_mark_pixels.h"

namespace edgesplat::passes {

gpu::Specialization mark_pixels_constants(const DrawVariant& variant, TileDraw how) {
    gpu::Specialization constants = draw_constants(variant);
    constants.emplace_back(shader::SPEC_ROUNDS, how.profile->rounds ? 1U : 0U);
    constants.emplace_back(shader::SPEC_PREPARED, how.prepared ? 1U : 0U);
    constants.emplace_back(shader::SPEC_REFINED, how.refined ? 1U : 0U);
    constants.emplace_back(shader::SPEC_WIDE_MARKS, how.refined || how.wide_marks ? 1U : 0U);
    constants.emplace_back(shader::SPEC_LIST_PARTS, how.profile->list_parts);
    return constants;
}

void mark_pixels(gpu::Commands& commands, const DrawVariant& variant, TileDraw how, std::uint64_t tiles,
                 std::uint32_t round) {
    commands.dispatch("4h_mark_pixels.comp", mark_pixels_constants(variant, how), round, commands.groups_for(tiles, 1));
    commands.barrier();
}

}  // namespace edgesplat::passes
