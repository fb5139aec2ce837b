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

std::uint32_t pushed(const TileRound& round) {
    return round.round | round.tile_groups << 20U | (round.first_pixels ? 1U << 31U : 0U);
}

}  // namespace

gpu::Specialization trace_constants(const DrawVariant& variant, TileDraw how) {
    return constants_of(variant, how, how.profile->list_group);
}

gpu::Specialization tile_constants(const DrawVariant& variant, TileDraw how) {
    return constants_of(variant, how, tile_group(how));
}

void trace_faces(gpu::Commands& commands, const DrawVariant& variant, TileDraw how, std::uint64_t tiles,
                 const TileRound& round) {
    commands.dispatch("5_trace_faces.comp", trace_constants(variant, how), pushed(round),
                      commands.groups_for(tiles, 1));
    commands.barrier();
}

gpu::Specialization begin_constants(const DrawVariant& variant) {
    return {{shader::SPEC_ISO_COUNT, variant.iso_count},
            {shader::SPEC_CLIP_KEEP, variant.clip.keep},
            {shader::SPEC_CLIP_REMOVE, variant.clip.remove},
            {shader::SPEC_SHADOWS, variant.shadows},
            {shader::SPEC_GROUP, kBeginGroup}};
}

void begin_surfaces(gpu::Commands& commands, const DrawVariant& variant, const glm::ivec2& size) {
    const std::uint64_t pixels = static_cast<std::uint64_t>(size.x) * static_cast<std::uint64_t>(size.y);
    commands.dispatch("5_begin_surfaces.comp", begin_constants(variant), 0, commands.groups_for(pixels, kBeginGroup));
    commands.barrier();
}

void draw_surfaces(gpu::Commands& commands, const DrawVariant& variant, TileDraw how, const TileRound& round) {
    commands.dispatch("5_draw_surfaces.comp", tile_constants(variant, how), pushed(round),
                      commands.groups_for(round.groups, 1));
    commands.barrier();
}

void shade_surfaces(gpu::Commands& commands, const DrawVariant& variant, TileDraw how, const TileRound& round) {
    commands.dispatch("5_shade_surfaces.comp", tile_constants(variant, how), pushed(round),
                      commands.groups_for(round.groups, 1));
    commands.barrier();
}

void draw_tiles(gpu::Commands& commands, const DrawVariant& variant, TileDraw how, const TileRound& round) {
    commands.dispatch("5_draw_tiles.comp", tile_constants(variant, how), pushed(round),
                      commands.groups_for(round.groups, 1));
    commands.barrier();
}

}  // namespace edgesplat::passes
