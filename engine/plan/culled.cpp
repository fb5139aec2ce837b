// Selects the splats of the list that a frame processes.
#include <algorithm>

#include "engine/plan/plan.h"

namespace edgesplat {
namespace {

void set_slots(FramePlan& plan, std::uint32_t slots) {
    auto& p = plan.params;
    p.slot_count = slots;
    // A splat of a sliced view takes one more iteration per sheet.
    p.sort_segment = std::max(shader::MOST_ITERATIONS / 2 / (plan.sheets_per_splat + 2), 1U);
    const std::uint32_t per_block = (slots + shader::SORT_BLOCKS - 1) / shader::SORT_BLOCKS;
    plan.sort_segments = std::max((per_block + p.sort_segment - 1) / p.sort_segment, 1U);
}

}  // namespace

void draw_first(FramePlan& plan, std::uint32_t splats) {
    plan.params.splat_count = splats;
    plan.splats_examined = splats;
    plan.variant.culled = false;
    plan.bricks.clear();
    plan.batches.clear();
    set_slots(plan, splats);
}

void cull_bricks(FramePlan& plan, const SplatBricks& bricks, const ViewVolume& view) {
    // Layers are drawn by splat number, not by slot.
    if (!plan.variant.tiles) return;
    plan.bricks = bricks.in_view(view, plan.reach);
    draw_bricks(plan, bricks, plan.bricks);
}

void draw_bricks(FramePlan& plan, const SplatBricks& bricks, std::span<const std::uint32_t> numbers) {
    // All gaps are at least a batch long, so slots < splats + SPLAT_BATCH.
    std::vector<glm::uvec2> batches = batches_of(bricks.parts_of(numbers, shader::SPLAT_BATCH));
    if (batches.size() * shader::SPLAT_BATCH < plan.params.splat_count) return draw_batches(plan, std::move(batches));
    plan.variant.culled = false;
    plan.batches.clear();
    plan.splats_examined = plan.params.splat_count;
    set_slots(plan, plan.params.splat_count);
}

void draw_batches(FramePlan& plan, std::vector<glm::uvec2> batches) {
    plan.variant.culled = true;
    plan.batches = std::move(batches);
    plan.splats_examined = 0;
    for (const glm::uvec2& batch : plan.batches)
        plan.splats_examined += batch.y;
    set_slots(plan, static_cast<std::uint32_t>(plan.batches.size()) * shader::SPLAT_BATCH);
}

}  // namespace edgesplat
