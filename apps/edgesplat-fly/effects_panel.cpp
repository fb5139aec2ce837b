#include <imgui.h>

#include <algorithm>

#include "apps/edgesplat-fly/panels.h"
#include "apps/edgesplat-fly/widgets.h"

namespace {

using edgesplat::SceneDocument;

/// Diagonal of the volume, mm.
double extent(const AppState& state) {
    const auto box = edgesplat::viewer::volume_box(state.session.volume().geometry);
    return glm::length(box.high - box.low);
}

void fog(AppState& state) {
    const Scope scope(state, "fog");
    const double length = extent(state);
    flag(state, "fog", state.session.document().effects.fog.has_value(), [&](SceneDocument& d, bool on) {
        d.effects.fog.reset();
        if (!on) return;
        // Fog begins at the near side of the volume and absorbs half of the light up to its far side.
        const auto& camera = state.session.motion().camera();
        const auto box = edgesplat::viewer::volume_box(state.session.volume().geometry);
        const double middle = glm::length((box.low + box.high) / 2.0 - camera.eye);
        d.effects.fog = edgesplat::Fog{d.background, 0.7 / length, std::max(middle - length / 2, 0.0)};
    });
    const auto now = state.session.document().effects.fog;
    if (!now) return;
    ImGui::SameLine();
    color(state, "##colour", now->color, [](SceneDocument& d, const glm::dvec3& v) { d.effects.fog->color = v; });
    slide(state, "density", now->density, {0, 50 / length, "%.4f per mm", true},
          [](SceneDocument& d, double v) { d.effects.fog->density = v; });
    slide(state, "from", now->start, {0, 3 * length, "%.1f mm"},
          [](SceneDocument& d, double v) { d.effects.fog->start = v; });
}

void silhouette(AppState& state) {
    const Scope scope(state, "silhouette");
    flag(state, "silhouettes", state.session.document().effects.silhouette.has_value(), [](SceneDocument& d, bool on) {
        d.effects.silhouette = on ? std::optional(edgesplat::Silhouette{}) : std::nullopt;
    });
    const auto now = state.session.document().effects.silhouette;
    if (!now) return;
    ImGui::SameLine();
    color(state, "##colour", now->color,
          [](SceneDocument& d, const glm::dvec3& v) { d.effects.silhouette->color = v; });
    slide(state, "strength", now->strength, {0, 1},
          [](SceneDocument& d, double v) { d.effects.silhouette->strength = v; });
    slide(state, "sharpness", now->sharpness, {0.25, 64, "%.2f", true},
          [](SceneDocument& d, double v) { d.effects.silhouette->sharpness = v; });
}

void occlusion(AppState& state) {
    const Scope scope(state, "occlusion");
    const double length = extent(state);
    flag(state, "ambient occlusion", state.session.document().effects.occlusion.has_value(),
         [&](SceneDocument& d, bool on) {
             d.effects.occlusion = on ? std::optional(edgesplat::AmbientOcclusion{1, length / 20}) : std::nullopt;
         });
    const auto now = state.session.document().effects.occlusion;
    if (!now) return;
    slide(state, "strength", now->strength, {0, 1},
          [](SceneDocument& d, double v) { d.effects.occlusion->strength = v; });
    slide(state, "radius", now->radius, {length / 1000, length, "%.2f mm", true},
          [](SceneDocument& d, double v) { d.effects.occlusion->radius = v; });
}

}  // namespace

void effects_panel(AppState& state) {
    fog(state);
    silhouette(state);
    occlusion(state);
    const edgesplat::Effects effects = state.session.document().effects;
    flag(state, "antialiased footprints", effects.antialias,
         [](SceneDocument& d, bool on) { d.effects.antialias = on; });
    flag(state, "smooth outlines", effects.smooth_outlines,
         [](SceneDocument& d, bool on) { d.effects.smooth_outlines = on; });
    slide(state, "samples a pixel", effects.samples, 1, edgesplat::kMaxSamples,
          [](SceneDocument& d, int v) { d.effects.samples = v; });
    if (ImGui::IsItemHovered())
        ImGui::SetTooltip("across and down the pixel: renders %d pictures", effects.samples * effects.samples);
}
