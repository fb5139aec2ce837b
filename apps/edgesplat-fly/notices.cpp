#include <imgui.h>

#include "apps/edgesplat-fly/panels.h"

void notices(AppState& state) {
    const ImVec2 size = ImGui::GetIO().DisplaySize;
    constexpr auto kFlags = ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_AlwaysAutoResize |
                            ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoMove;
    if (state.loading) {
        ImGui::SetNextWindowPos({size.x / 2, size.y / 2}, ImGuiCond_Always, {0.5F, 0.5F});
        ImGui::Begin("loading", nullptr, kFlags);
        ImGui::Text("reading %s", state.loading->path().c_str());
        ImGui::ProgressBar(static_cast<float>(state.loading->fraction()), {24 * static_cast<float>(state.em), 0},
                           state.loading->what().c_str());
        ImGui::End();
    }
    if (state.error.empty()) return;
    ImGui::SetNextWindowPos({size.x / 2, size.y / 3}, ImGuiCond_Always, {0.5F, 0.5F});
    ImGui::Begin("error", nullptr, kFlags);
    ImGui::PushTextWrapPos(40 * static_cast<float>(state.em));
    ImGui::TextUnformatted(state.error.c_str());
    ImGui::PopTextWrapPos();
    if (ImGui::Button("close")) state.error.clear();
    ImGui::End();
}
