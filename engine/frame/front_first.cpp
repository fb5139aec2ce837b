// PictureDrawer: pictures without the bricks that what is in front of them hides.
#include <algorithm>
#include <iterator>
#include <limits>

#include "engine/frame/picture.h"
#include "engine/gpu/read_back.h"

namespace edgesplat {

bool PictureDrawer::draw_front_first(const LevelStore& level, const passes::TileDraw& how) {
    const auto& collected = level.splats.collected();
    if (!session_->profile().front_first || !collected || !collected->buried) return false;
    const SplatLists& splats = level.splats.lists();
    const TargetResources& targets = targets_.resources();
    gpu::Commands& commands = session_->commands();
    const auto divided = divide_front(plan_, splats.bricks, culling_.least_hiding);
    if (!divided) return false;
    const FramePlan whole = plan_;
    draw_bricks(plan_, splats.bricks, divided->front);
    targets_.provide(plan_, splats);
    Chunks chunks = sort_frame(commands, plan_, targets, {.slab = glm::ivec2(0, divided->sheet)});
    times_ = commands.span_times();
    if (whole.refined && worth_refining(chunks)) {
        plan_ = whole;
        targets_.provide(plan_, splats);
        return false;
    }
    plan_.refined = false;
    passes::TileDraw front = how;
    front.part = true;
    draw_chunks(chunks, front);
    const auto counts = targets.drawn.mapped<std::uint32_t>(3);
    const std::uint32_t evaluated = counts[1], of_open = counts[2];
    const auto in_front = static_cast<std::uint32_t>(chunks.entries);
    const auto pairs_now = targets.sheet_pairs.mapped<std::uint32_t>(plan_.params.sheet_count);
    const std::vector<std::uint32_t> pairs(pairs_now.begin(), pairs_now.begin() + chunks.sheets.y);
    const std::uint64_t looked_at = plan_.looked_at;
    const auto closed =
        gpu::read_back<std::uint32_t>(session_->device(), commands, targets.tile_closed, 0, tile_count(plan_));

    const OpenTiles open(plan_, closed);
    std::vector<std::uint32_t> shown;
    std::ranges::copy_if(divided->rest, std::back_inserter(shown),
                         [&](std::uint32_t number) { return open.may_show(splats.bricks.bricks()[number].box); });
    draw_bricks(plan_, splats.bricks, shown);
    targets_.provide(plan_, splats);
    chunks = sort_frame(commands, plan_, targets,
                        {.slab = glm::ivec2(divided->sheet, std::numeric_limits<int>::max()), .goes_on = true});
    add_times(times_, commands.span_times());
    draw_chunks(chunks, how);
    // What is known of the picture is of both parts.
    plan_.looked_at += looked_at;
    std::ranges::copy(pairs, pairs_now.begin());
    counts[0] = in_front + static_cast<std::uint32_t>(chunks.entries);
    counts[1] += evaluated;
    counts[2] += of_open;
    return true;
}

}  // namespace edgesplat
