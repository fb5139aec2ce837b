// When the passes of a tiled frame run: all at once, or in rounds between which the host looks at the lists.
#include <algorithm>

#include "engine/compositors/tiles/lists.h"
#include "engine/frame/frame.h"

namespace edgesplat {
namespace {

/// Steps of a picture from `first` to `last`, each half of the one before.
struct Steps {
    std::uint32_t first = 1, last = 1;
    bool finish = true;  ///< what follows a step's pixels runs, too
};

std::vector<PassTime> at_once(gpu::Commands& commands, const FramePlan& plan, const TargetResources& targets,
                              TilePasses& frame, const Steps& steps) {
    commands.run([&] {
        for (const gpu::Buffer* written : {&targets.chunks, &targets.tile_todo})
            commands.to_device(*written);
        for (std::uint32_t step = steps.first; step >= steps.last; step /= 2) {
            const std::uint64_t tiles = tile_count(plan);
            for (std::uint32_t chunk = 0; chunk < frame.chunk_count(); ++chunk) {
                // The lists of a single chunk stand until the picture is there.
                if (step == steps.first || frame.chunk_count() > 1) frame.sort(chunk);
                frame.prepare(chunk);
                frame.draw(chunk, step, tiles, tiles * tile_groups(frame.how(), step), 0);
            }
            if (steps.finish) frame.finish(step);
        }
        if (!steps.finish) commands.to_host(targets.output);
    });
    return commands.span_times();
}

std::vector<PassTime> in_rounds(gpu::Commands& commands, const FramePlan& plan, const TargetResources& targets,
                                TilePasses& frame, const Steps& steps, const std::function<void()>& between) {
    std::vector<PassTime> times;
    const auto run = [&](const auto& body) {
        commands.run(body);
        add_times(times, commands.span_times());
    };
    const bool refined = frame.how().refined;
    TileOrder order(plan, targets, passes::tile_group(frame.how()));
    KeptLists kept(plan, targets, frame.chunk_count());
    for (std::uint32_t step = steps.first; step >= steps.last; step /= 2) {
        order.clear();
        const std::uint32_t count = order.any_todo() ? frame.chunk_count() : 0;
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
                    frame.see_tiles();
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
                    if (steps.finish) frame.finish(step);
                });
                break;
            }
            // Whether lists that were kept still serve is seen once the chunk before is drawn, and others lie
            // elsewhere.
            if (refined && order.groups_in(round) > 0) {
                run([&] {
                    draw_rest();
                    frame.see_tiles();
                });
            }
            if (!refined || !kept.take(chunk)) {
                if (refined) kept.place(chunk, padded_pairs(frame.most_pairs(chunk), plan.params.tiles));
                run([&] {
                    draw_rest();
                    frame.sort(chunk);
                    frame.see_tiles();
                });
                if (refined) kept.keep(chunk);
            }
            order.sort(tile_groups(frame.how(), step));
        }
    }
    return times;
}

std::vector<PassTime> draw(gpu::Commands& commands, const FramePlan& plan, const TargetResources& targets,
                           std::uint32_t chunks, passes::TileDraw how, const Steps& steps,
                           const std::function<void()>& between) {
    std::ranges::fill(targets.drawn.mapped<std::uint32_t>(3).last(2), 0U);
    if (steps.first == first_step(plan)) fill_todo(plan, targets);
    TilePasses frame(commands, plan, targets, chunks, how);
    return how.profile->rounds ? in_rounds(commands, plan, targets, frame, steps, between)
                               : at_once(commands, plan, targets, frame, steps);
}

}  // namespace

std::vector<PassTime> draw_tiles(gpu::Commands& commands, const FramePlan& plan, const TargetResources& targets,
                                 std::uint32_t chunks, passes::TileDraw how, const std::function<void()>& between) {
    return draw(commands, plan, targets, chunks, how, {.first = first_step(plan), .last = 1}, between);
}

std::vector<PassTime> draw_step(gpu::Commands& commands, const FramePlan& plan, const TargetResources& targets,
                                std::uint32_t chunks, passes::TileDraw how, std::uint32_t step) {
    how.part = true;
    return draw(commands, plan, targets, chunks, how, {.first = step, .last = step, .finish = false}, {});
}

}  // namespace edgesplat
