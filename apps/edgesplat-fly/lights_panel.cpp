#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>

#include "apps/edgesplat-fly/panels.h"
#include "apps/edgesplat-fly/pen.h"
#include "apps/edgesplat-fly/widgets.h"

namespace {

namespace viewer = edgesplat::viewer;
using edgesplat::Light;
using edgesplat::SceneDocument;
using Kind = Light::Kind;

constexpr double kDisc = 2.6;  // em: radius
constexpr std::array<std::pair<Kind, const char*>, 3> kKinds{
    {{Kind::Headlight, "headlight"}, {Kind::Directional, "directional"}, {Kind::Point, "point"}}};

/// The eye's axes as columns: right, up, towards the eye.
glm::dmat3 eyes_axes(const AppState& state) {
    const edgesplat::CameraFrame frame = edgesplat::camera_frame(state.session.motion().camera());
    return {frame.right, frame.up, -frame.forward};
}

void kind_choice(AppState& state, std::size_t i) {
    const Light light = state.session.document().lights[i];
    ImGui::SetNextItemWidth(8 * static_cast<float>(state.em));
    const bool open = ImGui::BeginCombo("##kind", kKinds[static_cast<std::size_t>(light.kind)].second);
    note(state, "kind");
    if (!open) return;
    for (const auto& [kind, name] : kKinds) {
        const bool chosen = ImGui::Selectable(name, kind == light.kind);
        note(state, name);
        if (!chosen) continue;
        state.session.edit([&, k = kind](SceneDocument& d) {
            Light& changed = d.lights.at(i);
            // Start from the current direction or place, so that nothing jumps.
            const glm::dmat3 axes = eyes_axes(state);
            if (k == Kind::Directional && changed.kind == Kind::Headlight) changed.direction = axes[2];
            if (k == Kind::Point && changed.kind != Kind::Point) changed.position = state.session.motion().camera().eye;
            changed.kind = k;
            changed.shadows = changed.shadows && k != Kind::Headlight;
        });
    }
    ImGui::EndCombo();
}

/// All directions as the eye sees them: light from the eye in the middle, from the side on the inner circle, from
/// behind on the rim.
void direction_disc(AppState& state, std::size_t i) {
    const double radius = kDisc * state.em;
    const ImVec2 corner = ImGui::GetCursorScreenPos();
    ImGui::InvisibleButton("direction", to_im(glm::dvec2(2 * radius)));
    note(state, "direction");
    const glm::dvec2 middle = glm::dvec2(static_cast<double>(corner.x), static_cast<double>(corner.y)) + radius;
    if (ImGui::IsItemActive()) {
        const ImVec2 at = ImGui::GetIO().MousePos;
        const glm::dvec2 way = (glm::dvec2(static_cast<double>(at.x), static_cast<double>(at.y)) - middle) / radius;
        const glm::dvec3 world = eyes_axes(state) * viewer::direction_of({way.x, -way.y});
        state.session.edit([&](SceneDocument& d) { d.lights.at(i).direction = world; }, false);
    }
    if (ImGui::IsItemHovered())
        ImGui::SetTooltip("where the light comes from: the middle is the eye,\nthe rim is behind the object");
    ImDrawList* list = ImGui::GetWindowDrawList();
    const auto r = static_cast<float>(radius);
    list->AddCircleFilled(to_im(middle), r, IM_COL32(24, 24, 28, 255));
    list->AddCircleFilled(to_im(middle), r / 2, IM_COL32(70, 72, 84, 255));
    list->AddCircle(to_im(middle), r, IM_COL32(110, 112, 124, 255));
    const Light& light = state.session.document().lights[i];
    const glm::dvec2 disc = viewer::disc_of(glm::transpose(eyes_axes(state)) * light.direction);
    const glm::dvec2 dot = middle + radius * 0.94 * glm::dvec2(disc.x, -disc.y);
    list->AddLine(to_im(middle), to_im(dot), painted(light.color, 0.6), 1.5F);
    list->AddCircleFilled(to_im(dot), static_cast<float>(0.35 * state.em), kShade);
    list->AddCircleFilled(to_im(dot), static_cast<float>(0.28 * state.em), painted(light.color));
}

void place(AppState& state, std::size_t i) {
    const Light light = state.session.document().lights[i];
    if (light.kind == Kind::Directional) {
        direction_disc(state, i);
        ImGui::SameLine();
        ImGui::BeginGroup();
        drag3(state, "##numbers", light.direction, 0.01, [i](SceneDocument& d, const glm::dvec3& v) {
            if (glm::length(v) > 0) d.lights.at(i).direction = v;
        });
        ImGui::TextDisabled("towards the light");
        if (button(state, "from the eye"))
            state.session.edit([&](SceneDocument& d) { d.lights.at(i).direction = eyes_axes(state)[2]; });
        ImGui::EndGroup();
    } else if (light.kind == Kind::Point) {
        const auto spacing = state.session.volume().geometry.spacing();
        drag3(state, "mm##position", light.position, std::max({spacing.x, spacing.y, spacing.z}),
              [i](SceneDocument& d, const glm::dvec3& v) { d.lights.at(i).position = v; });
        if (button(state, "to the eye"))
            state.session.edit(
                [&](SceneDocument& d) { d.lights.at(i).position = state.session.motion().camera().eye; });
    }
}

/// Edits a light. Returns whether it still exists.
bool one_light(AppState& state, std::size_t i) {
    const Scope scope(state, fmt::format("light{}", i));
    const Light light = state.session.document().lights[i];
    color(state, "##colour", light.color, [i](SceneDocument& d, const glm::dvec3& v) { d.lights.at(i).color = v; });
    ImGui::SameLine();
    kind_choice(state, i);
    ImGui::SameLine();
    if (button(state, "remove")) {
        state.session.edit(
            [i](SceneDocument& d) { d.lights.erase(d.lights.begin() + static_cast<std::ptrdiff_t>(i)); });
        return false;
    }
    slide(state, "intensity", light.intensity, {0, 2},
          [i](SceneDocument& d, double v) { d.lights.at(i).intensity = v; });
    place(state, i);
    const Light now = state.session.document().lights[i];
    if (now.kind != Kind::Headlight)
        flag(state, "shadows", now.shadows, [i](SceneDocument& d, bool on) { d.lights.at(i).shadows = on; });
    return true;
}

void background(AppState& state) {
    const SceneDocument document = state.session.document();
    color(state, "background", document.background, [](SceneDocument& d, const glm::dvec3& v) { d.background = v; });
    ImGui::SameLine();
    flag(state, "vertical gradient", document.effects.background_top.has_value(),
         [](SceneDocument& d, bool on) { d.effects.background_top = on ? std::optional(d.background) : std::nullopt; });
    const auto top = state.session.document().effects.background_top;
    if (!top) return;
    ImGui::SameLine();
    color(state, "##top", *top, [](SceneDocument& d, const glm::dvec3& v) { d.effects.background_top = v; });
}

}  // namespace

void lights_panel(AppState& state) {
    auto& session = state.session;
    for (std::size_t i = 0; i < session.document().lights.size();) {
        if (one_light(state, i)) ++i;
        ImGui::Separator();
    }
    if (session.document().lights.size() < edgesplat::kMaxLights && button(state, "add a light"))
        session.edit([&](SceneDocument& d) {
            const glm::dmat3 axes = eyes_axes(state);
            Light light = edgesplat::directional_light(glm::normalize(axes * glm::dvec3(-1, 1, 1)));
            light.intensity = 0.5;
            d.lights.push_back(light);
        });
    slide(state, "ambient light", session.document().ambient, {0, 1},
          [](SceneDocument& d, double v) { d.ambient = v; });
    flag(state, "light edges only", session.document().lit == edgesplat::Lit::Edges,
         [](SceneDocument& d, bool on) { d.lit = on ? edgesplat::Lit::Edges : edgesplat::Lit::Everywhere; });
    background(state);
}
