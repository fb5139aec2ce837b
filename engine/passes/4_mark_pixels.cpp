#include "engine/passes/4_mark_pixels.h"

namespace edgesplat::passes {

gpu::Pass mark_pixels(const DrawVariant& variant, TileDraw how, std::uint64_t tiles, std::uint32_t round) {
    gpu::Specialization constants = draw_constants(variant);
    constants.emplace_back(shader::SPEC_ROUNDS, how.profile->rounds ? 1U : 0U);
    constants.emplace_back(shader::SPEC_PREPARED, how.prepared ? 1U : 0U);
    constants.emplace_back(shader::SPEC_REFINED, how.refined ? 1U : 0U);
    constants.emplace_back(shader::SPEC_WIDE_MARKS, how.refined || how.wide_marks ? 1U : 0U);
    constants.emplace_back(shader::SPEC_LIST_PARTS, how.profile->list_parts);
    return {"4_mark_pixels", {{"4h_mark_pixels.comp", constants, gpu::Workgroups{tiles}, round}}};
}

}  // namespace edgesplat::passes
