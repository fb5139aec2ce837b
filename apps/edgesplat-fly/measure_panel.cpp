#include <fmt/format.h>
#include <imgui.h>

#include "apps/edgesplat-fly/panels.h"

void measure_panel(AppState& state) {
    if (!state.session.is_open()) return;
    const auto& session = state.session;
    const bool measuring = state.tool == Tool::Measure;
    if (ImGui::Button(measuring ? "click on surfaces..." : "pick surfaces"))
        state.tool = measuring ? Tool::Move : Tool::Measure;
    ImGui::SameLine();
    if (ImGui::Button("delete")) state.session.clear_picks();
    if (const auto ruler = session.ruler()) ImGui::Text("last two: %.2f ± %.2f mm", ruler->length, ruler->uncertainty);
    const auto& picks = session.picks();
    for (std::size_t i = picks.size(); i-- > 0 && i + 6 > picks.size();) {
        const auto& p = picks[i];
        ImGui::Text("%zu  %.2f, %.2f, %.2f mm", i + 1, p.world.x, p.world.y, p.world.z);
        ImGui::TextDisabled("   voxel %.2f, %.2f, %.2f  value %.8g", p.voxel.x, p.voxel.y, p.voxel.z,
                            state.session.volume().in_file_unit(p.value));
        ImGui::TextDisabled("   %.2f ± %.2f mm away", p.distance, p.uncertainty);
    }
}
