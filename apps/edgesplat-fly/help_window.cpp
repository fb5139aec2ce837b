#include <imgui.h>

#include "apps/edgesplat-fly/controls.h"
#include "apps/edgesplat-fly/panels.h"

void help_window(AppState& state) {
    if (!state.help) return;
    const ImVec2 size = ImGui::GetIO().DisplaySize;
    ImGui::SetNextWindowPos({size.x / 2, size.y / 2}, ImGuiCond_Always, {0.5F, 0.5F});
    ImGui::SetNextWindowSizeConstraints({0, 0}, {size.x, 0.95F * size.y});
    ImGui::Begin("keys and mouse", &state.help,
                 ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoCollapse | ImGuiWindowFlags_NoSavedSettings);
    if (ImGui::BeginTable("shortcuts", 4, ImGuiTableFlags_SizingFixedFit)) {
        for (const Shortcut& shortcut : shortcuts()) {
            ImGui::TableNextColumn();
            ImGui::TextColored({1, 0.85F, 0.4F, 1}, "%.*s", static_cast<int>(shortcut.keys.size()),
                               shortcut.keys.data());
            ImGui::TableNextColumn();
            ImGui::Text("%.*s   ", static_cast<int>(shortcut.what.size()), shortcut.what.data());
        }
        ImGui::EndTable();
    }
    ImGui::End();
}
