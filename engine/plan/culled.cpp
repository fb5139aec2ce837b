// Which splats of the list a frame goes through.
#include <algorithm>

#include "engine/plan/plan.h"

namespace edgesplat {
namespace {

void go_through(FramePlan& plan, std::uint32_t slots) {
    auto& p = plan.params;
    p.slot_count = slots;
    // A splat of a sliced view goes round once more for each sheet.
    p.sort_segment = std::max(shader::MOST_ITERATIONS / 2 / (plan.sheets_per_splat + 2), 1U);
    const std::uint32_t per_block = (slots + shader::SORT_BLOCKS - 1) / shader::SORT_BLOCKS;
    plan.sort_segments = std::max((per_block + p.sort_segment - 1) / p.sort_segment, 1U);
}

}  // namespace

void draw_first(FramePlan& plan, std::uint32_t splats) {
    plan.params.splat_count = splats;
    plan.looked_at = splats;
    plan.variant.culled = false;
    plan.bricks.clear();
    plan.batches.clear();
    go_through(plan, splats);
}

void cull_bricks(FramePlan& plan, const SplatBricks& bricks, const ViewVolume& view) {
    // Layers are drawn by the sheet of each splat, not of each slot.
    if (!plan.variant.tiles) return;
    plan.bricks = bricks.in_view(view, plan.reach);
    draw_bricks(plan, bricks, plan.bricks);
}

void draw_bricks(FramePlan& plan, const SplatBricks& bricks, std::span<const std::uint32_t> numbers) {
    // With gaps no shorter than a batch there are no more slots than splats, but for less than a batch.
    plan.batches = batches_of(bricks.parts_of(numbers, shader::SPLAT_BATCH));
    const auto slots = static_cast<std::uint32_t>(plan.batches.size()) * shader::SPLAT_BATCH;
    plan.variant.culled = slots < plan.params.splat_count;
    if (!plan.variant.culled) plan.batches.clear();
    plan.looked_at = plan.variant.culled ? 0 : plan.params.splat_count;
    for (const glm::uvec2& batch : plan.batches)
        plan.looked_at += batch.y;
    go_through(plan, plan.variant.culled ? slots : plan.params.splat_count);
}

}  // namespace edgesplat
