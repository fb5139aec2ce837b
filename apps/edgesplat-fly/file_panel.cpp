#include <fmt/format.h>
#include <imgui.h>
#include <imgui_stdlib.h>

#include <algorithm>

#include "apps/edgesplat-fly/controls.h"
#include "apps/edgesplat-fly/panels.h"
#include "engine/viewer/keeping.h"
#include "engine/volume/analytic_volumes.h"

namespace {

void recent_files(AppState& state) {
    for (const std::string& path : state.preferences.recent)
        if (ImGui::Selectable(path.c_str())) state.pending_requests.open = path;
    ImGui::Separator();
    for (const std::string_view name : edgesplat::analytic_scene_names()) {
        const std::string path = fmt::format("builtin:{}", name);
        if (ImGui::Selectable(path.c_str())) state.pending_requests.open = path;
    }
}

void saving(AppState& state) {
    static std::string scene = "scene.toml", picture = "picture.png";
    static int width = 0;
    if (ImGui::InputText("scene", &scene, ImGuiInputTextFlags_EnterReturnsTrue))
        state.pending_requests.save_scene = scene;
    ImGui::SameLine();
    if (ImGui::Button("save##scene")) state.pending_requests.save_scene = scene;
    if (ImGui::InputText("picture", &picture, ImGuiInputTextFlags_EnterReturnsTrue))
        state.pending_requests.save_picture = picture;
    ImGui::SameLine();
    if (ImGui::Button("save##picture")) state.pending_requests.save_picture = picture;
    ImGui::InputInt("width", &width, 256, 1024);
    width = std::clamp(width, 0, 16384);
    ImGui::TextDisabled(width == 0 ? "size as displayed" : "rendered in the background, PNG or EXR");
    const glm::ivec2 shown = state.picture_size();
    if (width > 0 && shown.x > 0)
        state.pending_requests.picture_size = {width, std::clamp(width * shown.y / shown.x, 1, 16384)};
}

}  // namespace

void file_panel(AppState& state) {
    static std::string path;
    if (ImGui::InputText("path", &path, ImGuiInputTextFlags_EnterReturnsTrue) && !path.empty())
        state.pending_requests.open = path;
    ImGui::SameLine();
    if (ImGui::Button("open") && !path.empty()) state.pending_requests.open = path;
    if (ImGui::TreeNode("recent and builtin")) {
        recent_files(state);
        ImGui::TreePop();
    }
    if (!state.session.is_open()) return;
    saving(state);
    const auto& recorder = state.session.recorder();
    if (ImGui::Button(recorder.recording() ? "stop recording" : "record the flight")) toggle_recording(state);
    if (recorder.recording() || !recorder.empty()) {
        ImGui::SameLine();
        ImGui::Text("%.1f s", recorder.seconds());
    }
}
