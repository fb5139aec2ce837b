#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <utility>

#include "apps/edgesplat-fly/panels.h"
#include "apps/edgesplat-fly/widgets.h"
#include "engine/error.h"
#include "engine/viewer/transfer_edit.h"
#include "engine/volume/value_text.h"

namespace {

namespace viewer = edgesplat::viewer;
using edgesplat::SceneDocument;

constexpr double kStep = 1.0 / 1024;  // width of an iso-value's step, as a share of the volume's range

void to_materials(AppState& state) {
    auto& session = state.session;
    state.editing.stored_transfer = session.document().transfer;
    session.edit([&](SceneDocument& d) { viewer::use_materials(d, session.volume()); });
}

void to_transfer(AppState& state) {
    auto& session = state.session;
    auto points = std::exchange(state.editing.stored_transfer, {});
    if (points.empty()) {
        const auto low = static_cast<double>(session.volume().min_value);
        const auto high = static_cast<double>(session.volume().max_value);
        points = viewer::transfer_of_materials(session.scene(), low, high, kStep * (high - low));
        for (auto& point : points)
            point.value = session.volume().in_file_unit(point.value);
    }
    state.editing.plot.chosen.reset();
    session.edit([&](SceneDocument& d) { viewer::use_transfer(d, points); });
}

}  // namespace

void presets_choice(AppState& state, const char* label, edgesplat::PresetKind kind,
                    const std::function<void(const edgesplat::ScenePreset&)>& take) {
    const bool open = ImGui::BeginCombo(label, "choose");
    note(state, label);
    if (!open) return;
    auto& presets = state.editing.presets;
    if (presets.empty())
        for (const std::string& name : edgesplat::scene_preset_names())
            try {
                presets.push_back(edgesplat::scene_preset(name));
            } catch (const edgesplat::Error& error) {
                state.session.say(error.what());
            }
    for (const auto& preset : presets) {
        if (preset.kind != kind) continue;
        const bool chosen = ImGui::Selectable(preset.name.c_str());
        note(state, preset.name.c_str());
        if (ImGui::IsItemHovered()) ImGui::SetTooltip("%s", preset.content.about.c_str());
        if (chosen) take(preset);
    }
    ImGui::EndCombo();
}

void color_source(AppState& state) {
    const bool transfer = !state.session.document().transfer.empty();
    const bool materials = ImGui::RadioButton("materials", !transfer);
    note(state, "materials");
    ImGui::SameLine();
    const bool function = ImGui::RadioButton("transfer function", transfer);
    note(state, "transfer function");
    if (materials && transfer) to_materials(state);
    if (function && !transfer) to_transfer(state);
}

void transfer_panel(AppState& state) {
    auto& session = state.session;
    const Scope scope(state, "transfer");
    presets_choice(state, "preset", edgesplat::PresetKind::Transfer, [&](const edgesplat::ScenePreset& preset) {
        state.editing.plot.chosen.reset();
        session.edit([&](SceneDocument& d) { viewer::use_transfer_preset(d, session.volume(), preset); });
    });
    const auto points = session.document().transfer;
    auto& chosen = state.editing.plot.chosen;
    if (chosen && *chosen >= points.size()) chosen.reset();
    if (!chosen) {
        ImGui::TextDisabled("%zu points; click one in the plot to edit it here", points.size());
        return;
    }
    const std::size_t i = *chosen;
    const auto& volume = session.volume();
    const double low = volume.in_file_unit(static_cast<double>(volume.min_value));
    const double high = volume.in_file_unit(static_cast<double>(volume.max_value));
    const std::string format = edgesplat::value_format(volume);
    const double gap = 1e-5 * (high - low);
    color(state, "##colour", points[i].color,
          [i](SceneDocument& d, const glm::dvec3& v) { d.transfer.at(i).color = v; });
    ImGui::SameLine();
    ImGui::AlignTextToFramePadding();
    ImGui::Text("point %zu of %zu", i + 1, points.size());
    ImGui::SameLine();
    if (button(state, "remove")) {
        session.edit([&](SceneDocument& d) { viewer::remove_transfer_point(d.transfer, i); });
        chosen.reset();
        return;
    }
    slide(state, "value", points[i].value, {low, high, format.c_str()}, [&](SceneDocument& d, double v) {
        viewer::move_transfer_point(d.transfer, i, v, d.transfer.at(i).extinction, gap);
    });
    const auto scale = viewer::ExtinctionScale::of(volume.geometry);
    slide(state, "per mm", points[i].extinction, {0, scale.most, "%.4f", true}, [&](SceneDocument& d, double v) {
        viewer::move_transfer_point(d.transfer, i, d.transfer.at(i).value, v, gap);
    });
}
