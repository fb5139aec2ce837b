#include "engine/frame/frame.h"

#include <algorithm>

#include "engine/frame/tiles/tile_passes.h"
#include "engine/frame/tiles_cpu/lists.h"
#include "engine/frame/tiles_cpu/rounds.h"
#include "engine/passes/3_select_footprints.h"
#include "engine/passes/4_sort_sheets.h"
#include "engine/passes/4_sort_tiles.h"
#include "engine/passes/5_draw_splats.h"
#include "engine/passes/6_composite_sheet.h"
#include "engine/passes/7_resolve.h"

namespace edgesplat {
namespace {

/// The refinement steps of a picture, each half of the one before.
void record_steps(const FramePlan& plan, TilePasses& frame) {
    const std::uint32_t first = first_step(plan);
    for (std::uint32_t step = first; step > 0; step /= 2) {
        const std::uint64_t tiles = tile_count(plan);
        for (std::uint32_t chunk = 0; chunk < frame.chunk_count(); ++chunk) {
            // A single chunk's lists remain valid for all steps.
            if (step == first || frame.chunk_count() > 1) frame.sort(chunk);
            frame.prepare(chunk);
            frame.draw(chunk, step, tiles, tiles * tile_groups(frame.how(), step), 0);
        }
        frame.finish(step);
    }
}

std::vector<PassTime> without_rounds(gpu::Commands& commands, const FramePlan& plan, const TargetResources& targets,
                                     TilePasses& frame) {
    commands.run([&] {
        for (const gpu::Buffer* written : {&targets.chunks, &targets.tile_todo})
            commands.to_device(*written);
        record_steps(plan, frame);
    });
    return commands.span_times();
}

void begin_counts(const TargetResources& targets) {
    std::ranges::fill(targets.drawn.mapped<std::uint32_t>(3).last(2), 0U);
}

}  // namespace

std::vector<PassTime> draw_layers(gpu::Commands& commands, const FramePlan& plan, const TargetResources& targets) {
    const auto& p = plan.params;
    const passes::DrawSplats draw{plan.variant, targets.sheets, targets.depth, targets.indices, targets.draws};
    commands.run([&] {
        commands.fill(targets.counters, 0);
        passes::clear_accumulated(commands, targets.accumulated);
        commands.pass(passes::select_footprints(p.slot_count, plan.variant));
        commands.pass(passes::sort_sheets(commands.profile(), plan.variant, p, plan.sort_segments));
        for (std::uint32_t group = 0; group < p.group_count; ++group) {
            commands.span("5_draw_splats", [&] { passes::draw_splats(commands, draw, group); });
            commands.span("6_composite_sheet",
                          [&] { passes::composite_sheet(commands, targets.accumulated, plan.variant.payload, group); });
        }
        commands.pass(passes::resolve(plan.variant, p.size, plan.gradient));
        commands.to_host(targets.output);
    });
    return commands.span_times();
}

glm::uvec2 SheetRange::in_picture(const shader::FrameParams& params) const {
    const auto counted = [&](int number) {
        return static_cast<std::uint32_t>(
            std::clamp<std::int64_t>(std::int64_t{number} - params.sheet_base, 0, params.sheet_count));
    };
    return {counted(begin), counted(end)};
}

Chunks sort_frame(gpu::Commands& commands, const FramePlan& plan, const TargetResources& targets,
                  const SheetRange& range) {
    commands.run([&] { sort_splats(commands, plan, targets, range.continues); });
    return chunks_of(plan, targets, range.in_picture(plan.params), commands.profile());
}

std::optional<Chunks> draw_at_once(gpu::Commands& commands, const FramePlan& plan, const TargetResources& targets,
                                   passes::TileDraw how) {
    how.planned = true;
    fill_todo(plan, targets);
    begin_counts(targets);
    const auto& p = plan.params;
    TilePasses frame(commands, plan, targets, p.chunk_slots, how);
    commands.run([&] {
        commands.to_device(targets.tile_todo);
        sort_splats(commands, plan, targets, false);
        commands.pass(passes::plan_chunks());
        record_steps(plan, frame);
    });
    Chunks chunks = chunks_of(plan, targets, {0, p.sheet_count}, commands.profile());
    return fit(chunks, p, p.chunk_slots) ? std::optional(std::move(chunks)) : std::nullopt;
}

std::vector<PassTime> draw_tiles(gpu::Commands& commands, const FramePlan& plan, const TargetResources& targets,
                                 std::uint32_t chunks, passes::TileDraw how, const std::function<void()>& between) {
    fill_todo(plan, targets);
    begin_counts(targets);
    TilePasses frame(commands, plan, targets, chunks, how);
    return how.profile->rounds ? draw_in_rounds(commands, plan, targets, frame, between)
                               : without_rounds(commands, plan, targets, frame);
}

std::vector<PassTime> join_volumes(gpu::Commands& commands, const FramePlan& plan, const TargetResources& targets) {
    commands.run([&] { end_picture_of_volumes(commands, plan, targets); });
    return commands.span_times();
}

}  // namespace edgesplat
