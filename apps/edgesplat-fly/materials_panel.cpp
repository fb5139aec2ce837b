#include <fmt/format.h>
#include <imgui.h>
#include <imgui_stdlib.h>

#include <algorithm>

#include "apps/edgesplat-fly/panels.h"
#include "apps/edgesplat-fly/widgets.h"
#include "engine/viewer/iso_edit.h"
#include "engine/viewer/transfer_edit.h"
#include "engine/volume/value_text.h"

namespace {

namespace viewer = edgesplat::viewer;
using edgesplat::MaterialChoice;
using edgesplat::SceneDocument;

/// For example "bone, from 300".
std::string title(const edgesplat::Scene& scene, const edgesplat::Volume& volume, std::size_t m) {
    std::vector<double> values = scene.iso_values;
    for (double& value : values)
        value = volume.in_file_unit(value);
    const double range = volume.in_file_unit(static_cast<double>(volume.max_value - volume.min_value));
    const std::vector<std::string> iso = edgesplat::value_texts(values, range);
    std::string text = scene.materials[m].name;
    if (!text.empty()) text += ", ";
    if (!scene.label_colors.empty()) return text + (m == 0 ? "around the labels" : "labels");
    if (iso.empty()) return text + "all values";
    if (m == 0) return text + fmt::format("below {}", iso.front());
    text += fmt::format("from {}", iso[m - 1]);
    return m < iso.size() ? text + fmt::format(" to {}", iso[m]) : text;
}

void name_field(AppState& state, std::size_t m) {
    std::string name = state.session.scene().materials[m].name;
    const bool changed = ImGui::InputText("name", &name);
    note(state, "name");
    if (changed) state.session.edit([&](SceneDocument& d) { viewer::material_choice(d, m).name = name; }, false);
}

/// A slider of the light response; `member` of the document's material.
void response(AppState& state, std::size_t m, const char* label, double value, const SlideRange& range,
              std::optional<double> MaterialChoice::*member) {
    slide(state, label, value, range, [m, member](SceneDocument& d, double v) {
        viewer::material_choice(d, m).*member = v;
        if (member == &MaterialChoice::extinction) d.volume.opacity.reset();
    });
}

/// Edits an iso-value. Returns whether it still exists.
bool iso_value(AppState& state, std::size_t m) {
    auto& session = state.session;
    const auto& volume = session.volume();
    const double value = session.document().iso_values[m - 1];
    // This slider stops at the neighbouring iso-values, since beyond them it would belong to another material.
    const auto iso = session.document().iso_values;
    const double low = volume.in_file_unit(static_cast<double>(volume.min_value));
    const double high = volume.in_file_unit(static_cast<double>(volume.max_value));
    const std::string format = edgesplat::value_format(volume);
    const double gap = viewer::kIsoGap * (high - low);
    const double least = m > 1 ? iso[m - 2] + gap : low, most = m < iso.size() ? iso[m] - gap : high;
    slide(state, "iso", value, {low, high, format.c_str()}, [&](SceneDocument& d, double v) {
        viewer::move_iso_value(d, volume, m - 1, std::clamp(v, least, std::max(least, most)));
    });
    const bool needed = session.document().transfer.empty() && session.scene().iso_values.size() == 1;
    if (needed) return true;
    ImGui::SameLine();
    if (!button(state, "remove")) return true;
    session.edit([&](SceneDocument& d) { viewer::remove_iso_value(d, m - 1); });
    return false;
}

void details(AppState& state, std::size_t m) {
    auto& session = state.session;
    const bool materials = session.document().transfer.empty();
    const bool labels = session.volume().is_label_mask();
    if (m > 0 && !labels && !iso_value(state, m)) return;
    const edgesplat::Material material = session.scene().materials.at(m);
    if (materials) {
        const auto scale = viewer::ExtinctionScale::of(session.volume().geometry);
        response(state, m, "per mm", material.extinction, {0, scale.most, "%.4f", true}, &MaterialChoice::extinction);
        name_field(state, m);
        presets_choice(state, "preset", edgesplat::PresetKind::Material, [&](const edgesplat::ScenePreset& preset) {
            session.edit([&](SceneDocument& d) { viewer::apply_material_preset(d, session.volume(), m, preset); });
        });
    }
    const edgesplat::LightResponse light = session.scene().materials.at(m).response;
    response(state, m, "ambient", light.ambient, {0, 2}, &MaterialChoice::ambient);
    response(state, m, "diffuse", light.diffuse, {0, 2}, &MaterialChoice::diffuse);
    response(state, m, "specular", light.specular, {0, 2}, &MaterialChoice::specular);
    response(state, m, "shininess", light.shininess, {1, 1000, "%.0f", true}, &MaterialChoice::shininess);
}

void material(AppState& state, std::size_t m) {
    const bool materials = state.session.document().transfer.empty();
    const Scope scope(state, fmt::format("material{}", m));
    const bool labels = m > 0 && state.session.volume().is_label_mask();
    if (materials && !labels) {
        color(state, "##colour", state.session.scene().materials[m].color,
              [m](SceneDocument& d, const glm::dvec3& v) { viewer::material_choice(d, m).color = v; });
        ImGui::SameLine();
    }
    const std::string text = title(state.session.scene(), state.session.volume(), m);
    const bool open = ImGui::TreeNodeEx("material", ImGuiTreeNodeFlags_SpanAvailWidth, "%s", text.c_str());
    note(state, "title");
    if (!open) return;
    details(state, m);
    ImGui::TreePop();
}

}  // namespace

void materials_panel(AppState& state) {
    // From the highest values down, since these are usually the opaque ones.
    for (std::size_t m = state.session.scene().materials.size(); m-- > 0;)
        if (m < state.session.scene().materials.size()) material(state, m);
}
