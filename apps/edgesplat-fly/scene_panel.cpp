#include <imgui.h>

#include "apps/edgesplat-fly/panels.h"
#include "apps/edgesplat-fly/widgets.h"

namespace {

/// Resets the state kept between frames when the volume changes.
void reset_for_volume(AppState& state) {
    const auto& volume = state.session.opened().volume;
    SceneEditing& editing = state.editing;
    if (editing.volume == volume) return;
    editing.volume = volume;
    editing.plot = {};
    editing.plot.low = volume->in_file_unit(static_cast<double>(volume->min_value));
    editing.plot.high = volume->in_file_unit(static_cast<double>(volume->max_value));
    editing.stored_transfer.clear();
}

void undo_buttons(AppState& state) {
    auto& session = state.session;
    ImGui::BeginDisabled(!session.can_undo());
    if (button(state, "undo")) session.undo();
    ImGui::EndDisabled();
    ImGui::SameLine();
    ImGui::BeginDisabled(!session.can_redo());
    if (button(state, "redo")) session.redo();
    ImGui::EndDisabled();
}

void values_panel(AppState& state) {
    presets_choice(state, "look", edgesplat::PresetKind::Look, [&](const edgesplat::ScenePreset& preset) {
        state.session.edit([&](edgesplat::SceneDocument& d) {
            const edgesplat::VolumeSource read = d.volume;
            edgesplat::apply_look(d, preset.name);
            d.volume = read;
        });
    });
    if (state.session.volume().is_label_mask()) return materials_panel(state);
    color_source(state);
    histogram_panel(state);
    if (!state.session.document().transfer.empty()) transfer_panel(state);
    materials_panel(state);
}

}  // namespace

void scene_panel(AppState& state) {
    if (!state.session.is_open()) return;
    reset_for_volume(state);
    const Scope scope(state, "scene");
    undo_buttons(state);
    if (!ImGui::BeginTabBar("parts")) return;
    constexpr std::array<std::pair<const char*, void (*)(AppState&)>, 5> kParts{{{"Values", values_panel},
                                                                                 {"Light", lights_panel},
                                                                                 {"Effects", effects_panel},
                                                                                 {"Clip", clip_panel},
                                                                                 {"Volumes", volumes_panel}}};
    for (const auto& [name, panel] : kParts) {
        const bool open = ImGui::BeginTabItem(name);
        note(state, name);
        if (!open) continue;
        panel(state);
        ImGui::EndTabItem();
    }
    if (state.session.opened().samples) {
        const bool open = ImGui::BeginTabItem("Labels");
        note(state, "Labels");
        if (open) {
            labels_panel(state);
            ImGui::EndTabItem();
        }
    }
    ImGui::EndTabBar();
}
