#include "engine/frame/tiles/tile_passes.h"

#include <algorithm>
#include <bit>

#include "engine/passes/3_select_footprints.h"
#include "engine/passes/4_mark_pixels.h"
#include "engine/passes/4_prepare_splats.h"
#include "engine/passes/4_sort_sheets.h"
#include "engine/passes/4_sort_tiles.h"
#include "engine/passes/5_refine_pixels.h"
#include "engine/passes/6_join_surfaces.h"
#include "engine/passes/6_merge_surfaces.h"
#include "engine/passes/7_resolve.h"

namespace edgesplat {
namespace {

void merge(gpu::Commands& commands, const FramePlan& plan, passes::Merge how) {
    commands.pass(passes::merge_surfaces(how, plan.params.size));
}

}  // namespace

void end_picture(gpu::Commands& commands, const FramePlan& plan, const TargetResources& targets) {
    const glm::ivec2& size = plan.params.size;
    commands.pass(passes::join_surfaces(plan.variant, size));
    // A pixel on an outline also blends in its neighbour's colour before pass 7.
    if (plan.variant.outlines) {
        commands.copy(targets.output, targets.tile_sheets, {{0, 0, picture_bytes(plan)}});
        commands.barrier();
    }
    commands.pass(passes::resolve(plan.variant, size, plan.gradient));
    commands.to_host(targets.output);
}

void end_picture_of_volumes(gpu::Commands& commands, const FramePlan& plan, const TargetResources& targets) {
    for (const gpu::Buffer* zeroed : {&targets.output, &targets.surfaces_passed})
        commands.fill(*zeroed, 0);
    commands.barrier();
    merge(commands, plan, passes::Merge::Take);
    end_picture(commands, plan, targets);
}

void sort_splats(gpu::Commands& commands, const FramePlan& plan, const TargetResources& targets, bool continues) {
    if (plan.variant.culled) commands.to_device(targets.batches);
    for (const gpu::Buffer* zeroed : {&targets.counters, &targets.sheet_pairs})
        commands.fill(*zeroed, 0);
    if (!continues) {
        const passes::DrawVariant& v = plan.variant;
        for (const gpu::Buffer* zeroed : {&targets.tile_closed, &targets.output})
            commands.fill(*zeroed, 0);
        // A pixel without votes: negative words in its first texel (surface_pixel.glsl).
        if (v.surfaces && !v.begins)
            commands.fill(targets.tile_sheets, std::bit_cast<std::uint32_t>(-1.0F), 0, picture_bytes(plan));
        // The kernels of a mixture add to the outlines of its surfaces.
        if (targets.outlines && plan.first) commands.fill(targets.outlines, shader::NO_OUTLINE);
        if (v.mixed) commands.fill(v.surfaces ? targets.tile_ends : targets.surfaces_passed, 0);
    }
    if (plan.refined) commands.fill(targets.tile_finest, std::bit_cast<std::uint32_t>(1e30F));
    commands.barrier();
    if (!continues && plan.variant.several && !plan.variant.surfaces) merge(commands, plan, passes::Merge::Take);
    if (!continues) commands.pass(passes::begin_surfaces(plan.variant, plan.params.size));
    commands.pass(passes::select_footprints(plan.params.slot_count, plan.variant));
    commands.pass(passes::sort_sheets(commands.profile(), plan.variant, plan.params, plan.sort_segments));
    for (const gpu::Buffer* seen : {&targets.sheet_pairs, &targets.sheet_starts})
        commands.to_host(*seen);
}

TilePasses::TilePasses(gpu::Commands& commands, const FramePlan& plan, const TargetResources& targets,
                       std::uint32_t chunks, passes::TileDraw how)
    : commands_(commands),
      plan_(plan),
      targets_(targets),
      how_(how),
      parts_(targets.chunks.mapped<glm::uvec2>(chunks)),
      prepared_(chunks) {
    how_.refined = plan.refined;
    how_.wide_marks = plan.wide_marks;
}

std::uint64_t TilePasses::most_pairs(std::uint32_t chunk, std::uint32_t columns) const {
    return most_column_pairs(parts_[chunk], columns, sheet_pairs(plan_, targets_), sheet_starts(plan_, targets_));
}

void TilePasses::sort(std::uint32_t chunk) {
    // The parallel sort processes a column in one dispatch.
    const std::uint64_t in_column = how_.profile->side_by_side ? 0 : most_pairs(chunk, plan_.params.tile_blocks);
    const auto steps = static_cast<std::uint32_t>((in_column + shader::PAIR_STEPS - 1) / shader::PAIR_STEPS);
    if (how_.refined) {
        const std::uint64_t first = targets_.frame.mapped<shader::FrameBlock>(1)[0].frame.entries_first;
        const std::uint64_t room = padded_pairs(most_pairs(chunk), plan_.params.tiles);
        commands_.fill(targets_.tile_marks, ~0U, first * sizeof(std::uint32_t), room * sizeof(std::uint32_t));
    }
    commands_.fill(targets_.tile_counters, 0);
    commands_.barrier();
    commands_.pass(passes::sort_tiles(*how_.profile, plan_.params, chunk, steps));
}

void TilePasses::prepare(std::uint32_t chunk) {
    const std::uint32_t places = plan_.params.prepared_mask + 1;
    if (entries(chunk) > places || prepared_[chunk]) return;
    // Places are reused in turn: if the order has more entries than places, earlier chunks are overwritten.
    if (parts_.back().y - parts_.front().x > places) std::fill(prepared_.begin(), prepared_.end(), false);
    prepared_[chunk] = true;
    commands_.pass(passes::prepare_splats(plan_.variant, chunk, entries(chunk)));
}

void TilePasses::draw(std::uint32_t chunk, std::uint32_t step, std::uint64_t tiles, std::uint64_t groups,
                      std::uint32_t round) {
    passes::TileDraw of_chunk = how_;
    // A chunk with more splats than places is drawn from the splat list directly.
    of_chunk.prepared = entries(chunk) <= plan_.params.prepared_mask + 1;
    const passes::TileRound part{.groups = groups,
                                 .round = round,
                                 .tile_groups = tile_groups(how_, step),
                                 .first_pixels = how_.refined && step == shader::REFINE_STEP};
    commands_.pass(passes::mark_pixels(plan_.variant, of_chunk, tiles, round));
    commands_.pass(passes::trace_faces(plan_.variant, of_chunk, tiles, part));
    commands_.pass(passes::draw_tiles(plan_.variant, of_chunk, part));
}

void TilePasses::shade(std::uint32_t step) {
    const passes::TileRound all{.groups = tile_count(plan_) * tile_groups(how_, step),
                                .round = how_.part ? 1U : 0U,
                                .tile_groups = tile_groups(how_, step),
                                .first_pixels = how_.refined && step == shader::REFINE_STEP};
    commands_.pass(passes::shade_surfaces(plan_.variant, how_, all));
}

void TilePasses::copy_saturated_to_host() {
    if (!how_.refined || !how_.profile->rounds) return;
    commands_.copy(targets_.tile_closed, targets_.tile_closed_on_host,
                   {{0, 0, tile_count(plan_) * sizeof(std::uint32_t)}});
    commands_.barrier();
}

void TilePasses::finish(std::uint32_t step) {
    shade(step);
    if (step > 1) {
        commands_.pass(passes::refine_pixels(plan_.variant, tile_count(plan_), step));
        copy_saturated_to_host();
    } else if (plan_.variant.mixed && plan_.variant.surfaces) {
        if (plan_.variant.several && !how_.part)
            merge(commands_, plan_, plan_.first ? passes::Merge::Begin : passes::Merge::Add);
        // Other parts are drawn next; the picture so far is only checked.
        for (const gpu::Buffer* seen : {&targets_.output, &targets_.tile_ends})
            commands_.to_host(*seen);
    } else if (!how_.part) {
        end_picture(commands_, plan_, targets_);
    }
}

}  // namespace edgesplat
