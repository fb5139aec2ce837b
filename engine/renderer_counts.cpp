// Renderer::count_fragments: what drawing comes to, counted by the device.
#include <algorithm>

#include "engine/renderer_state.h"

namespace edgesplat {

void Renderer::count_fragments(bool on) {
    state_->counting = on;
    state_->commands.count_draws(on);
}

void RendererState::add_counts(RenderStats& stats) const {
    if (!counting) return;
    if (const auto counts = commands.draw_counts()) {
        DrawCounts& sum = stats.draw_counts ? *stats.draw_counts : stats.draw_counts.emplace();
        sum.vertices += counts->vertices;
        sum.fragments += counts->fragments;
        sum.shaded += counts->shaded;
    }
    const auto groups = targets.groups.mapped<shader::SheetGroup>(plan.params.group_count);
    double covered = 0;
    for (const shader::SheetGroup& group : groups)
        covered += static_cast<double>(std::max(group.rect.z - group.rect.x, 0)) *
                   static_cast<double>(std::max(group.rect.w - group.rect.y, 0));
    const double pixels = static_cast<double>(plan.params.size.x) * static_cast<double>(plan.params.size.y);
    stats.dirty_share = covered / pixels / static_cast<double>(groups.size());
}

}  // namespace edgesplat
