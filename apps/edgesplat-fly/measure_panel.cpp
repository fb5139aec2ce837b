#include <fmt/format.h>
#include <imgui.h>

#include "apps/edgesplat-fly/panels.h"
#include "engine/scene/label_choice.h"
#include "engine/volume/labels.h"

namespace {

/// The label or the value at a picked place.
std::string value_text(const edgesplat::Volume& volume, const edgesplat::viewer::ValueThere& there) {
    std::string value = volume.is_label_mask() ? "" : fmt::format("value {:g}", volume.in_file_unit(there.value));
    if (!volume.shown_labels) return value;
    const std::uint32_t number = edgesplat::label_at(volume, there.voxel);
    if (number == 0) return value;
    return fmt::format("{}{}label {}", value, value.empty() ? "" : ", ",
                       text_of(*volume.labels, volume.labels->labels[number - 1]));
}

}  // namespace

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
    const edgesplat::Scene& scene = session.scene();
    const auto of_volume = [&](const edgesplat::viewer::ValueThere& there) {
        return value_text(edgesplat::viewer::volume_of(session.volume(), scene, there.number), there);
    };
    for (std::size_t i = picks.size(); i-- > 0 && i + 6 > picks.size();) {
        const auto& p = picks[i];
        ImGui::Text("%zu  %.2f, %.2f, %.2f mm", i + 1, p.world.x, p.world.y, p.world.z);
        ImGui::TextDisabled("   voxel %.2f, %.2f, %.2f  %s", p.voxel.x, p.voxel.y, p.voxel.z,
                            of_volume({p.number, p.voxel, p.value}).c_str());
        if (!scene.added.empty())
            for (const auto& there : edgesplat::viewer::values_at(session.volume(), scene, p.world))
                if (there.number != p.number)
                    ImGui::TextDisabled("   volume %zu  %s", there.number + 1, of_volume(there).c_str());
        ImGui::TextDisabled("   %.2f ± %.2f mm away", p.distance, p.uncertainty);
    }
}
