#include <fmt/format.h>
#include <imgui.h>
#include <imgui_stdlib.h>

#include <algorithm>
#include <cctype>
#include <numeric>

#include "apps/edgesplat-fly/panels.h"
#include "apps/edgesplat-fly/widgets.h"
#include "engine/error.h"
#include "engine/scene/default_materials.h"
#include "engine/scene/label_choice.h"
#include "engine/scene/label_fade.h"
#include "engine/volume/labels.h"

namespace {

using edgesplat::LabelTable;
using edgesplat::SceneDocument;

std::string lower(std::string text) {
    std::ranges::transform(text, text.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return text;
}

/// Which labels the document shows, by place; computed again when it changes.
const std::vector<bool>& shown_labels(AppState& state, const edgesplat::Volume& samples, const LabelTable& table) {
    LabelList& list = state.editing.labels;
    const edgesplat::VolumeSource& source = state.session.document().volume;
    if (list.samples == &samples && list.only == source.only && list.hide == source.hide) return list.shown;
    list.samples = &samples;
    list.only = source.only;
    list.hide = source.hide;
    try {
        list.background = background_label(samples, table);
        list.shown = chosen_labels(samples, table, source.only, source.hide);
    } catch (const edgesplat::Error& error) {
        state.session.say(error.what());
        list.shown.assign(table.labels.size(), true);
    }
    return list.shown;
}

/// Shows those labels, by the shorter of both lists; the `chosen` ones, by place, are no longer faded. With a
/// segmentation of its own a volume has other matter, too: it is hidden if `alone`.
void show_labels(AppState& state, const LabelTable& table, const std::vector<bool>& shown, bool alone,
                 const std::vector<std::size_t>& chosen) {
    std::vector<std::string> only, hide;
    const std::size_t background = state.editing.labels.background;
    for (std::size_t place = 0; place < shown.size(); ++place) {
        if (shown[place])
            only.push_back(table.number_of(table.labels[place]));
        else if (place != background)
            hide.push_back(table.number_of(table.labels[place]));
    }
    if (only.empty()) {
        state.session.say("at least one label must be shown");
        return;
    }
    const bool of_scan = background >= shown.size();
    const bool by_hiding = of_scan ? !alone : !shown[background] && hide.size() <= only.size();
    state.session.edit([&](SceneDocument& d) {
        for (const std::size_t place : chosen) {
            const std::string number = table.number_of(table.labels[place]);
            if (edgesplat::opacity_of_labels(d, number) < 1) edgesplat::fade_labels(d, number, 1);
        }
        d.volume.only = by_hiding ? std::vector<std::string>{} : only;
        d.volume.hide = by_hiding ? hide : std::vector<std::string>{};
    });
}

void own_colors(AppState& state) {
    flag(state, "own colours", state.session.document().volume.labels.value_or(false), [](SceneDocument& d, bool on) {
        d.volume.labels = on;
        if (on) {
            d.iso_values.clear();
            d.transfer.clear();
            d.materials.clear();
            return;
        }
        d.volume.only.clear();
        d.volume.hide.clear();
    });
}

/// A slider for the opacity of a label.
void fade(AppState& state, const std::string& number) {
    const double now = edgesplat::opacity_of_labels(state.session.document(), number);
    slide(state, ("##fade" + number).c_str(), now, {0.05, 1, "%.2f"},
          [&](SceneDocument& d, double opacity) { edgesplat::fade_labels(d, number, opacity); });
}

}  // namespace

void labels_panel(AppState& state) {
    const std::shared_ptr<const edgesplat::Volume> samples = state.session.opened().samples;
    const auto table = labels_of(*samples);
    const Scope scope(state, "labels");
    const bool of_scan = samples->has_segmentation();
    const bool alone = !state.session.document().volume.only.empty();
    if (!of_scan) own_colors(state);
    if (!state.session.volume().shown_labels) return;
    const std::vector<bool> shown = shown_labels(state, *samples, *table);
    if (of_scan) {
        bool others = !alone;
        if (ImGui::Checkbox("matter of no label", &others)) show_labels(state, *table, shown, !others, {});
        note(state, "others");
    }
    std::string& wanted = state.editing.labels.search;
    ImGui::InputTextWithHint("##search", "number or name", &wanted);
    note(state, "search");
    const std::string part = lower(wanted);
    std::vector<std::size_t> places;
    for (std::size_t place = 0; place < table->labels.size(); ++place)
        if (part.empty() || lower(text_of(*table, table->labels[place])).find(part) != std::string::npos)
            places.push_back(place);
    // These buttons act on the labels that the search finds.
    if (button(state, "show")) {
        std::vector<bool> next = shown;
        for (const std::size_t place : places)
            next[place] = next[place] || place != state.editing.labels.background;
        show_labels(state, *table, next, alone, places);
    }
    ImGui::SameLine();
    if (button(state, "hide")) {
        std::vector<bool> next = shown;
        for (const std::size_t place : places)
            next[place] = false;
        show_labels(state, *table, next, alone, places);
    }
    ImGui::SameLine();
    if (button(state, "only these")) {
        std::vector<bool> next(shown.size(), false);
        for (const std::size_t place : places)
            next[place] = place != state.editing.labels.background;
        std::vector<std::size_t> all(shown.size());
        std::iota(all.begin(), all.end(), std::size_t{0});
        show_labels(state, *table, next, true, all);
    }
    ImGui::BeginChild("list", {0, 16 * static_cast<float>(state.em)}, true);
    const std::vector<glm::dvec3>& colors = state.session.scene().label_colors;
    ImGuiListClipper clipper;
    clipper.Begin(static_cast<int>(places.size()));
    while (clipper.Step())
        for (int row = clipper.DisplayStart; row < clipper.DisplayEnd; ++row) {
            const std::size_t place = places[static_cast<std::size_t>(row)];
            const edgesplat::Label& label = table->labels[place];
            const std::string number = table->number_of(label);
            ImGui::PushID(number.c_str());
            bool on = shown[place] || edgesplat::opacity_of_labels(state.session.document(), number) < 1;
            const bool clicked = ImGui::Checkbox("##on", &on);
            note(state, number.c_str());
            ImGui::SameLine();
            const unsigned swatch = painted(place < colors.size() ? colors[place] : glm::dvec3(0));
            ImGui::ColorButton("##colour", ImGui::ColorConvertU32ToFloat4(swatch), ImGuiColorEditFlags_NoTooltip);
            ImGui::SameLine();
            if (place != state.editing.labels.background) {
                ImGui::SetNextItemWidth(4 * static_cast<float>(state.em));
                fade(state, number);
                ImGui::SameLine();
            }
            ImGui::TextUnformatted(text_of(*table, label).c_str());
            ImGui::PopID();
            if (!clicked) continue;
            std::vector<bool> next = shown;
            next[place] = on;
            show_labels(state, *table, next, alone, {place});
        }
    ImGui::EndChild();
}
