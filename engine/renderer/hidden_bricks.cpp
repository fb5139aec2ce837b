// RendererState: pictures without the bricks that what is in front of them hides.
#include <algorithm>
#include <iterator>
#include <limits>

#include "engine/compositors/tiles/hiding.h"
#include "engine/gpu/read_back.h"
#include "engine/renderer/state.h"

namespace edgesplat {

bool RendererState::draw_front_first(const passes::TileDraw& how) {
    if (!device.profile().front_first || !collected || !collected->buried) return false;
    const auto divided = divide_front(plan, volume_resources.bricks, least_hiding);
    if (!divided) return false;
    const FramePlan whole = plan;
    draw_bricks(plan, volume_resources.bricks, divided->front);
    provide_targets(plan);
    Chunks chunks = sort_frame(commands, plan, targets, {.slab = glm::ivec2(0, divided->sheet)});
    draw_times = commands.span_times();
    if (whole.refined && worth_refining(chunks)) {
        plan = whole;
        provide_targets(plan);
        return false;
    }
    plan.refined = false;
    passes::TileDraw front = how;
    front.part = true;
    draw_chunks(chunks, front);
    const auto counts = targets.drawn.mapped<std::uint32_t>(3);
    const std::uint32_t evaluated = counts[1], of_open = counts[2];
    const auto in_front = static_cast<std::uint32_t>(chunks.entries);
    const auto pairs_now = targets.sheet_pairs.mapped<std::uint32_t>(plan.params.sheet_count);
    const std::vector<std::uint32_t> pairs(pairs_now.begin(), pairs_now.begin() + chunks.sheets.y);
    const std::uint64_t looked_at = plan.looked_at;
    const auto closed = gpu::read_back<std::uint32_t>(device, commands, targets.tile_closed, 0, tile_count(plan));

    const OpenTiles open(plan, closed);
    std::vector<std::uint32_t> shown;
    std::ranges::copy_if(divided->rest, std::back_inserter(shown), [&](std::uint32_t number) {
        return open.may_show(volume_resources.bricks.bricks()[number].box);
    });
    draw_bricks(plan, volume_resources.bricks, shown);
    provide_targets(plan);
    chunks = sort_frame(commands, plan, targets,
                        {.slab = glm::ivec2(divided->sheet, std::numeric_limits<int>::max()), .goes_on = true});
    add_times(draw_times, commands.span_times());
    draw_chunks(chunks, how);
    // What is known of the picture is of both parts.
    plan.looked_at += looked_at;
    std::ranges::copy(pairs, pairs_now.begin());
    counts[0] = in_front + static_cast<std::uint32_t>(chunks.entries);
    counts[1] += evaluated;
    counts[2] += of_open;
    return true;
}

}  // namespace edgesplat
