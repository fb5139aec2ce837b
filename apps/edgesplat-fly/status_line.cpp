#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <cmath>

#include "apps/edgesplat-fly/panels.h"
#include "engine/scene/ladder.h"
#include "engine/viewer/pick.h"

namespace {

std::string picture_text(const AppState& state) {
    const auto& shown = *state.shown;
    std::string text = fmt::format("{}x{}", state.picture_size().x, state.picture_size().y);
    if (shown.rung.scale < 1) text += fmt::format(" at {:g} % scale", 100 * shown.rung.scale);
    if (shown.rung.rays) text += ", ray cast";
    if (shown.rung.level > 0) text += fmt::format(", voxels {} times as wide", 1 << shown.rung.level);
    if (!shown.stats.complete) text += ", reading more data";
    text += shown.moving ? " | moving" : !shown.finished ? " | refining" : shown.best ? " | accurate" : " | complete";
    text += fmt::format(" | {:.0f} ms", shown.milliseconds);
    if (shown.coarse_error && shown.coarse_rung)
        text += fmt::format(" | error in motion {:.1f} % RMS", 100 * *shown.coarse_error);
    const std::string knobs = edgesplat::difference(state.session.document().quality.settings);
    if (!knobs.empty()) text += " | " + knobs;
    return text;
}

std::string place_text(const AppState& state) {
    const auto& session = state.session;
    const auto& eye = session.motion().camera().eye;
    std::string text = fmt::format("eye {:.1f}, {:.1f}, {:.1f} mm", eye.x, eye.y, eye.z);
    if (session.walls()) {
        const double room = session.walls()->distance(eye);
        if (std::isfinite(room)) text += fmt::format(" | wall {:.1f} mm", room);
    }
    if (session.motion().mode() == edgesplat::viewer::MotionMode::Fly)
        text += fmt::format(" | {:.0f} mm/s", session.motion().speed() * state.boost * state.preferences.speed);
    return text;
}

}  // namespace

void status_line(AppState& state, double top, double height) {
    const ImVec2 size = ImGui::GetIO().DisplaySize;
    ImGui::SetNextWindowPos({0, static_cast<float>(top)});
    ImGui::SetNextWindowSize({size.x, static_cast<float>(height)});
    ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding,
                        {0.4F * static_cast<float>(state.em), 0.15F * static_cast<float>(state.em)});
    ImGui::Begin("status", nullptr,
                 ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoSavedSettings |
                     ImGuiWindowFlags_NoFocusOnAppearing | ImGuiWindowFlags_NoNav);
    std::string text = "F1 help";
    if (state.session.is_open()) {
        text = place_text(state);
        if (state.shown) text = picture_text(state) + "   " + text;
        if (state.drawer && state.drawer->found() < 1)
            text = fmt::format("finding surfaces {:.0f} % | ", 100 * state.drawer->found()) + text;
    }
    ImGui::TextUnformatted(text.c_str());
    const std::string& message = state.session.message();
    if (!message.empty()) {
        const float width = ImGui::CalcTextSize(message.c_str()).x;
        ImGui::SameLine(std::max(size.x - width - static_cast<float>(state.em), 0.0F));
        ImGui::TextColored({1, 0.85F, 0.4F, 1}, "%s", message.c_str());
    }
    ImGui::End();
    ImGui::PopStyleVar();
}
