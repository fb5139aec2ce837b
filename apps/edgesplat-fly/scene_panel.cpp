#include <imgui.h>

#include "apps/edgesplat-fly/panels.h"

void scene_panel(AppState& state) {
    if (!state.session.is_open()) return;
    ImGui::TextUnformatted("...");
}
