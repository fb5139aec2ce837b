// Decides when the passes of a tiled frame run: all in one command list, or in rounds between which the host reads the
// tile lists.
#include <algorithm>

#include "engine/frame/frame.h"
#include "engine/passes/4_sort_tiles.h"

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

std::vector<PassTime> in_rounds(gpu::Commands& commands, const FramePlan& plan, const TargetResources& targets,
                                TilePasses& frame, const std::function<void()>& between) {
    std::vector<PassTime> times;
    const auto run = [&](const auto& body) {
        commands.run(body);
        add_times(times, commands.span_times());
    };
    const bool refined = frame.how().refined;
    TileOrder order(plan, targets, passes::tile_group(frame.how()));
    KeptLists kept(plan, targets, frame.chunk_count());
    for (std::uint32_t step = first_step(plan); step > 0; step /= 2) {
        order.clear();
        const std::uint32_t count = order.has_pixels_to_draw() ? frame.chunk_count() : 0;
        for (std::uint32_t chunk = 0; chunk <= count; ++chunk) {
            std::uint32_t round = 0;
            const auto draw_round = [&] {
                if (round == 0) frame.prepare(chunk - 1);
                frame.draw(chunk - 1, step, order.tiles_in(round), order.groups_in(round), round);
                ++round;
            };
            while (between && order.groups_in(round) > 0) {
                run([&] {
                    draw_round();
                    frame.copy_saturated_to_host();
                });
                between();
            }
            const auto draw_rest = [&] {
                while (order.groups_in(round) > 0)
                    draw_round();
            };
            if (chunk == count) {
                run([&] {
                    draw_rest();
                    frame.finish(step);
                });
                break;
            }
            // The chunk before must be drawn first: its saturated tiles decide whether kept lists are still valid, and
            // take() then points to other lists.
            if (refined && order.groups_in(round) > 0) {
                run([&] {
                    draw_rest();
                    frame.copy_saturated_to_host();
                });
            }
            if (!refined || !kept.take(chunk)) {
                if (refined) kept.place(chunk, padded_pairs(frame.most_pairs(chunk), plan.params.tiles));
                run([&] {
                    draw_rest();
                    frame.sort(chunk);
                    frame.copy_saturated_to_host();
                });
                if (refined) kept.keep(chunk);
            }
            order.sort(tile_groups(frame.how(), step));
        }
    }
    return times;
}

void begin_counts(const TargetResources& targets) {
    std::ranges::fill(targets.drawn.mapped<std::uint32_t>(3).last(2), 0U);
}

}  // namespace

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
    return how.profile->rounds ? in_rounds(commands, plan, targets, frame, between)
                               : without_rounds(commands, plan, targets, frame);
}

}  // namespace edgesplat
