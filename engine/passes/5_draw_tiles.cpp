#include "engine/passes/5_draw_tiles.h"

namespace edgesplat::passes {

std::uint32_t tile_group(TileDraw how) {
    return how.refined ? how.profile->list_group : how.profile->tile_group;
}

namespace {

gpu::Specialization constants_of(const DrawVariant& variant, TileDraw how, std::uint32_t group) {
    gpu::Specialization constants = draw_constants(variant);
    constants.emplace_back(shader::SPEC_ROUNDS, how.profile->rounds ? 1U : 0U);
    constants.emplace_back(shader::SPEC_COUNT, how.count ? 1U : 0U);
    constants.emplace_back(shader::SPEC_PREPARED, how.prepared ? 1U : 0U);
    constants.emplace_back(shader::SPEC_REFINED, how.refined ? 1U : 0U);
    constants.emplace_back(shader::SPEC_WIDE_MARKS, how.refined || how.wide_marks ? 1U : 0U);
    constants.emplace_back(shader::SPEC_GROUP, group);
    constants.emplace_back(shader::SPEC_OUTLINES, variant.outlines ? 1U : 0U);
    constants.emplace_back(shader::SPEC_MIXED, variant.mixed ? 1U : 0U);
    return constants;
}

/// A dispatch for the pixels of a round, in workgroups of `group` invocations.
gpu::Dispatch over_pixels(const char* shader, const DrawVariant& variant, TileDraw how, std::uint32_t group,
                          std::uint64_t groups, const TileRound& round) {
    return {shader, constants_of(variant, how, group), gpu::Workgroups{groups},
            round.round | round.tile_groups << 20U | (round.first_pixels ? 1U << 31U : 0U)};
}

}  // namespace

gpu::Pass trace_faces(const DrawVariant& variant, TileDraw how, std::uint64_t tiles, const TileRound& round) {
    gpu::Pass pass{"5_trace_faces", {}};
    if (variant.traced)
        pass.dispatches = {over_pixels("5_trace_faces.comp", variant, how, how.profile->list_group, tiles, round)};
    return pass;
}

gpu::Pass begin_surfaces(const DrawVariant& variant, const glm::ivec2& size) {
    gpu::Pass pass{"5_begin_surfaces", {}};
    if (variant.begins)
        pass.dispatches = {{"5_begin_surfaces.comp",
                            {{shader::SPEC_ISO_COUNT, variant.iso_count},
                             {shader::SPEC_CLIP_KEEP, variant.clip.keep},
                             {shader::SPEC_CLIP_REMOVE, variant.clip.remove},
                             {shader::SPEC_INNER, variant.inner ? 1U : 0U},
                             {shader::SPEC_SHADOWS, variant.shadows}},
                            gpu::per_pixel(size)}};
    return pass;
}

gpu::Pass draw_tiles(const DrawVariant& variant, TileDraw how, const TileRound& round) {
    const char* name = variant.surfaces ? "5_draw_surfaces" : "5_draw_tiles";
    const char* shader = variant.surfaces ? "5_draw_surfaces.comp" : "5_draw_tiles.comp";
    return {name, {over_pixels(shader, variant, how, tile_group(how), round.groups, round)}};
}

gpu::Pass shade_surfaces(const DrawVariant& variant, TileDraw how, const TileRound& round) {
    gpu::Pass pass{"5_shade_surfaces", {}};
    if (variant.surfaces)
        pass.dispatches = {over_pixels("5_shade_surfaces.comp", variant, how, tile_group(how), round.groups, round)};
    return pass;
}

}  // namespace edgesplat::passes
