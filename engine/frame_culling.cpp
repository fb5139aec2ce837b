// Which splats of the list a frame goes through.
#include <algorithm>

#include "engine/frame_plan.h"

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
    plan.variant.culled = false;
    plan.batches.clear();
    go_through(plan, splats);
}

void cull_bricks(FramePlan& plan, const SplatBricks& bricks, const ViewVolume& view, double reach) {
    // Layers are drawn by the sheet of each splat, not of each slot.
    if (!plan.variant.tiles) return;
    // With gaps no shorter than a batch there are no more slots than splats, but for less than a batch.
    const std::vector<ListPart> parts = bricks.in_view(view, reach, shader::SPLAT_BATCH);
    std::vector<glm::uvec2> batches = batches_of(parts);
    const auto slots = static_cast<std::uint32_t>(batches.size()) * shader::SPLAT_BATCH;
    if (slots >= plan.params.splat_count) return;
    plan.variant.culled = true;
    plan.batches = std::move(batches);
    go_through(plan, slots);
}

std::uint64_t culled_splats(const FramePlan& plan) {
    if (!plan.variant.culled) return 0;
    std::uint64_t looked_at = 0;
    for (const glm::uvec2& batch : plan.batches)
        looked_at += batch.y;
    return plan.params.splat_count - looked_at;
}

}  // namespace edgesplat
