#include "engine/frame/tiles_cpu/rounds.h"

#include "engine/frame/tiles_cpu/lists.h"

namespace edgesplat {

std::vector<PassTime> draw_in_rounds(gpu::Commands& commands, const FramePlan& plan, const TargetResources& targets,
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

}  // namespace edgesplat
