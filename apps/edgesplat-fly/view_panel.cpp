#include <fmt/format.h>
#include <imgui.h>

#include <array>
#include <utility>

#include "apps/edgesplat-fly/panels.h"
#include "engine/scene/views.h"

namespace {

using edgesplat::viewer::MotionMode;
using edgesplat::viewer::Show;

void shown(AppState& state) {
    auto& session = state.session;
    constexpr std::array<std::pair<Show, const char*>, 4> kWays{
        {{Show::Edges, "edges"}, {Show::Plain, "plain"}, {Show::Wipe, "wipe"}, {Show::Sharpening, "sharpened"}}};
    for (const auto& [show, name] : kWays) {
        if (show != Show::Edges) ImGui::SameLine();
        if (ImGui::RadioButton(name, session.show() == show)) session.set_show(show);
    }
}

void movement(AppState& state) {
    auto& motion = state.session.motion();
    if (ImGui::RadioButton("orbit", motion.mode() == MotionMode::Orbit)) motion.set_mode(MotionMode::Orbit);
    ImGui::SameLine();
    if (ImGui::RadioButton("fly", motion.mode() == MotionMode::Fly)) motion.set_mode(MotionMode::Fly);
    ImGui::SameLine();
    bool collisions = motion.collisions();
    if (ImGui::Checkbox("walls", &collisions)) {
        motion.set_collisions(collisions);
        state.preferences.collisions = collisions;
    }
    ImGui::SameLine();
    if (ImGui::Button("home")) motion.home();
    auto fov = static_cast<float>(motion.camera().fov_y);
    if (ImGui::SliderFloat("field of view", &fov, 5, 150, "%.0f°")) motion.set_fov(static_cast<double>(fov));
    auto speed = static_cast<float>(state.preferences.speed), turn = static_cast<float>(state.preferences.turn);
    if (ImGui::SliderFloat("speed", &speed, 0.1F, 10, "%.2f", ImGuiSliderFlags_Logarithmic))
        state.preferences.speed = static_cast<double>(speed);
    if (ImGui::SliderFloat("turning", &turn, 0.1F, 10, "%.2f", ImGuiSliderFlags_Logarithmic))
        state.preferences.turn = static_cast<double>(turn);
    ImGui::Checkbox("invert looking up and down", &state.preferences.invert_look);
}

void named_views(AppState& state) {
    auto& session = state.session;
    const glm::ivec2 size = state.picture_size();
    int column = 0;
    for (const std::string_view name : edgesplat::view_names()) {
        if (column++ % 4 != 0) ImGui::SameLine();
        if (!ImGui::SmallButton(std::string(name).c_str())) continue;
        const edgesplat::ViewRequest request{&session.volume(), &session.scene(), session.motion().camera().fov_y,
                                             size.x, size.y};
        const auto& geometry = session.volume().geometry;
        session.motion().fly_to(edgesplat::named_view(name, request), geometry.center(), 0.8);
    }
}

}  // namespace

void view_panel(AppState& state) {
    if (!state.session.is_open()) return;
    shown(state);
    movement(state);
    named_views(state);
    ImGui::Checkbox("scale bar, orientation, picks", &state.overlays);
    ImGui::SameLine();
    ImGui::Checkbox("slices", &state.slices);
}
