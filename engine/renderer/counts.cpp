// Renderer::count_fragments: what drawing comes to, counted by the device.
#include <algorithm>

#include "engine/renderer/state.h"

namespace edgesplat {
namespace {

/// Of the picture's pixels, those in tiles that a sheet's splats touch; on average over the sheets. Tiles that several
/// splats of a sheet touch count for each, up to all of the picture.
double dirty_share_of_tiles(const shader::FrameParams& p, const TargetResources& targets) {
    const double tiles = static_cast<double>(p.tiles.x) * p.tiles.y;
    double sum = 0;
    for (const std::uint32_t pairs : targets.sheet_pairs.mapped<std::uint32_t>(p.sheet_count))
        sum += std::min(pairs / tiles, 1.0);
    return sum / p.sheet_count;
}

}  // namespace

void Renderer::count_fragments(bool on) {
    state_->counting = on;
    state_->commands.count_draws(on);
}

void RendererState::add_counts(RenderStats& stats) const {
    if (!counting) return;
    const auto add = [&](const DrawCounts& counts) {
        DrawCounts& sum = stats.draw_counts ? *stats.draw_counts : stats.draw_counts.emplace();
        sum.vertices += counts.vertices;
        sum.fragments += counts.fragments;
        sum.shaded += counts.shaded;
    };
    if (plan.variant.tiles) {
        stats.dirty_share = dirty_share_of_tiles(plan.params, targets);
        const auto counts = targets.drawn.mapped<std::uint32_t>(3);
        add({.vertices = 0, .fragments = counts[1], .shaded = counts[2]});
        return;
    }
    if (const auto counts = commands.draw_counts()) add(*counts);
    const auto groups = targets.groups.mapped<shader::SheetGroup>(plan.params.group_count);
    double covered = 0;
    for (const shader::SheetGroup& group : groups)
        covered += static_cast<double>(std::max(group.rect.z - group.rect.x, 0)) *
                   static_cast<double>(std::max(group.rect.w - group.rect.y, 0));
    const double pixels = static_cast<double>(plan.params.size.x) * static_cast<double>(plan.params.size.y);
    stats.dirty_share = covered / pixels / static_cast<double>(groups.size());
}

}  // namespace edgesplat
