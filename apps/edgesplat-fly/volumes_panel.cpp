#include <fmt/format.h>
#include <imgui.h>
#include <imgui_stdlib.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <span>
#include <utility>

#include "apps/edgesplat-fly/panels.h"
#include "apps/edgesplat-fly/widgets.h"
#include "engine/scene/default_materials.h"
#include "engine/viewer/iso_edit.h"
#include "engine/viewer/transfer_edit.h"
#include "engine/volume/analytic_volumes.h"
#include "engine/volume/value_text.h"

namespace {

using edgesplat::SceneDocument;

/// The document's entry of an added volume, with its surfaces and materials written out, so that one can be changed.
SceneDocument& written_out(SceneDocument& d, const edgesplat::AddedVolume& added, std::size_t i) {
    SceneDocument& entry = d.volumes[i];
    if (entry.iso_values.empty() && !added.volume->is_label_mask())
        for (const double value : added.iso_values)
            entry.iso_values.push_back(added.volume->in_file_unit(value));
    if (entry.materials.empty())
        for (std::size_t m = 1; m < added.materials.size(); ++m)
            entry.materials.push_back(choice_of(added.materials[m]));
    return entry;
}

/// Colour and opacity of the highest material, and its iso-value.
void matter(AppState& state, std::size_t i, const edgesplat::AddedVolume& added) {
    if (!added.transfer.empty() || added.materials.size() < 2) return;
    const edgesplat::Volume& volume = *added.volume;
    const edgesplat::Material& top = added.materials.back();
    if (!volume.is_label_mask()) {
        color(state, "##colour", top.color,
              [&](SceneDocument& d, const glm::dvec3& v) { written_out(d, added, i).materials.back().color = v; });
        const double low = volume.in_file_unit(static_cast<double>(volume.min_value));
        const double high = volume.in_file_unit(static_cast<double>(volume.max_value));
        const double gap = edgesplat::viewer::kIsoGap * (high - low);
        const std::string format = edgesplat::value_format(volume);
        if (added.iso_values.size() == 1)
            slide(state, "iso", volume.in_file_unit(added.iso_values.front()), {low + gap, high, format.c_str()},
                  [&](SceneDocument& d, double v) { written_out(d, added, i).iso_values.front() = v; });
    }
    const auto scale = edgesplat::viewer::ExtinctionScale::of(volume.geometry);
    slide(state, "per mm", top.extinction, {0, scale.most, "%.4f", true}, [&](SceneDocument& d, double v) {
        written_out(d, added, i).materials.back().extinction = v;
        d.volumes[i].volume.opacity.reset();
    });
}

/// Whether a volume is shown and cut; `source` is its part of a document.
void switches(AppState& state, const edgesplat::VolumeSource& now,
              const std::function<edgesplat::VolumeSource&(SceneDocument&)>& source) {
    flag(state, "visible", now.visible, [&](SceneDocument& d, bool on) { source(d).visible = on; });
    ImGui::SameLine();
    flag(state, "clip", now.clip, [&](SceneDocument& d, bool on) { source(d).clip = on; });
}

/// What is seen where the volume overlaps others.
void rules(AppState& state, edgesplat::VolumeRule now, std::size_t i) {
    using enum edgesplat::VolumeRule;
    bool first = true;
    for (const auto& [rule, name] : {std::pair{Add, "add"}, {Inside, "inside"}, {Cut, "cut"}}) {
        if (!std::exchange(first, false)) ImGui::SameLine();
        if (ImGui::RadioButton(name, now == rule))
            state.session.edit([i, chosen = rule](SceneDocument& d) { d.volumes[i].volume.rule = chosen; });
        note(state, name);
    }
}

/// How far the volume is shifted from the file's place.
void place(AppState& state, const edgesplat::VolumeSource& now, std::size_t i) {
    glm::dvec3 shift(0);
    for (int axis = 0; axis < 3 && !now.transform.empty(); ++axis)
        shift[axis] = now.transform[static_cast<std::size_t>(4 * axis + 3)];
    drag3(state, "shift", shift, 0.5, [i](SceneDocument& d, const glm::dvec3& v) {
        std::vector<double>& rows = d.volumes[i].volume.transform;
        if (rows.empty()) rows = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
        for (int axis = 0; axis < 3; ++axis)
            rows[static_cast<std::size_t>(4 * axis + 3)] = v[axis];
    });
}

std::string short_name(const std::string& path) {
    return edgesplat::is_builtin(path) ? path : std::filesystem::path(path).filename().string();
}

}  // namespace

void volumes_panel(AppState& state) {
    auto& session = state.session;
    {
        const Scope scope(state, "volume0");
        ImGui::TextUnformatted(short_name(session.document().volume.path).c_str());
        switches(
            state, session.document().volume, [](SceneDocument & d) -> auto& { return d.volume; });
    }
    for (std::size_t i = 0; i < session.document().volumes.size(); ++i) {
        const Scope scope(state, fmt::format("volume{}", i + 1));
        const SceneDocument entry = session.document().volumes[i];
        ImGui::Separator();
        ImGui::TextUnformatted(short_name(entry.volume.path).c_str());
        switches(
            state, entry.volume, [i](SceneDocument & d) -> auto& { return d.volumes[i].volume; });
        ImGui::SameLine();
        if (button(state, "remove")) {
            session.edit(
                [i](SceneDocument& d) { d.volumes.erase(d.volumes.begin() + static_cast<std::ptrdiff_t>(i)); });
            break;
        }
        rules(state, entry.volume.rule, i);
        // Edits replace the document and the scene.
        const SceneDocument now = session.document().volumes[i];
        if (now.volume.visible && !cuts(now)) {
            const auto cutters = std::ranges::count_if(std::span(session.document().volumes).first(i), edgesplat::cuts);
            const edgesplat::AddedVolume added = session.scene().added[i - static_cast<std::size_t>(cutters)];
            matter(state, i, added);
        }
        place(state, now.volume, i);
    }
    ImGui::Separator();
    static std::string path;
    const bool entered = ImGui::InputText("file", &path, ImGuiInputTextFlags_EnterReturnsTrue);
    note(state, "file");
    ImGui::SameLine();
    if ((button(state, "add") || entered) && !path.empty())
        session.edit([](SceneDocument& d) {
            d.volumes.emplace_back().volume.path =
                edgesplat::is_builtin(path) ? path : std::filesystem::absolute(path).string();
        });
}
