#include "engine/frame/frame.h"

#include <algorithm>

#include "engine/passes/3_select_footprints.h"
#include "engine/passes/4_sort_sheets.h"
#include "engine/passes/5_draw_splats.h"
#include "engine/passes/6_composite_sheet.h"
#include "engine/passes/7_resolve.h"

namespace edgesplat {
void add_times(std::vector<PassTime>& sums, const std::vector<PassTime>& times) {
    for (const PassTime& time : times) {
        const auto same = std::ranges::find(sums, time.name, &PassTime::name);
        if (same == sums.end())
            sums.push_back(time);
        else
            same->milliseconds += time.milliseconds;
    }
}

void run_frame(gpu::Commands& commands, const FramePlan& plan, const TargetResources& targets) {
    const passes::DrawSplats draw{plan.variant, targets.sheets, targets.depth, targets.indices, targets.draws};

    commands.run([&] {
        commands.fill(targets.counters, 0);
        passes::clear_accumulated(commands, targets.accumulated);
        commands.span("3_select_footprints",
                      [&] { passes::select_footprints(commands, plan.params.slot_count, plan.variant); });
        commands.span("4_sort_sheets", [&] { passes::sort_sheets(commands, plan.variant, plan.sort_segments); });
        for (std::uint32_t group = 0; group < plan.params.group_count; ++group) {
            commands.span("5_draw_splats", [&] { passes::draw_splats(commands, draw, group); });
            commands.span("6_composite_sheet",
                          [&] { passes::composite_sheet(commands, targets.accumulated, plan.variant.payload, group); });
        }
        commands.span("7_resolve", [&] { passes::resolve(commands, plan.variant, plan.params.size, plan.gradient); });
    });
}

}  // namespace edgesplat
