// Edits iso-values and points of a transfer function over the histogram.
#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <cmath>

#include "apps/edgesplat-fly/panels.h"
#include "apps/edgesplat-fly/value_plot.h"
#include "apps/edgesplat-fly/widgets.h"
#include "engine/viewer/iso_edit.h"
#include "engine/volume/value_text.h"

namespace {

namespace viewer = edgesplat::viewer;
using edgesplat::SceneDocument;
using PlotKind = PlotState::Kind;
using Target = PlotState::Target;

constexpr double kPointReach = 0.55, kLineReach = 0.4, kSnap = 0.25;  // em

double gap_of(const edgesplat::Volume& volume) {
    return viewer::kIsoGap * volume.in_file_unit(static_cast<double>(volume.max_value - volume.min_value));
}

/// The point or line under the mouse; points have priority.
Target target_at(const AppState& state, const ValuePlot& plot) {
    const SceneDocument& document = state.session.document();
    Target target;
    double reach = kPointReach * state.em;
    for (std::size_t i = 0; i < document.transfer.size(); ++i) {
        const glm::dvec2 at(plot.x_of(document.transfer[i].value), plot.y_of(document.transfer[i].extinction));
        const double distance = glm::length(at - plot.mouse);
        if (distance > reach) continue;
        reach = distance;
        target = {PlotKind::Point, i};
    }
    if (target.kind == PlotKind::Point) return target;
    reach = kLineReach * state.em;
    for (std::size_t i = 0; i < document.iso_values.size(); ++i) {
        const double distance = std::abs(plot.x_of(document.iso_values[i]) - plot.mouse.x);
        if (distance > reach) continue;
        reach = distance;
        target = {PlotKind::Iso, i};
    }
    return target;
}

glm::dvec2 place_of(const AppState& state, const ValuePlot& plot, const Target& target) {
    const SceneDocument& document = state.session.document();
    if (target.kind == PlotKind::Iso) return {plot.x_of(document.iso_values[target.place]), plot.mouse.y};
    const auto& point = document.transfer[target.place];
    return {plot.x_of(point.value), plot.y_of(point.extinction)};
}

/// The value at x, snapped to a suggested iso-value nearby.
double snapped(AppState& state, const ValuePlot& plot, double x) {
    const auto* statistics = state.editing.counter.of(state.session.opened().volume, state.wait);
    if (statistics != nullptr)
        for (const auto& suggestion : statistics->suggestions)
            if (std::abs(plot.x_of(suggestion.value) - x) < kSnap * state.em) return suggestion.value;
    return plot.value_at(x);
}

/// Adds a point of the transfer function; in the strip, or without a function, an iso-value.
Target added(AppState& state, const ValuePlot& plot) {
    auto& session = state.session;
    const auto& volume = session.volume();
    const bool point = !session.document().transfer.empty() && plot.mouse.y < plot.bottom();
    std::optional<std::size_t> place;
    session.edit(
        [&](SceneDocument& d) {
            place = point ? viewer::add_transfer_point(d.transfer, plot.value_at(plot.mouse.x), gap_of(volume))
                          : viewer::add_iso_value(d, volume, snapped(state, plot, plot.mouse.x));
            if (!place || !point) return;
            viewer::move_transfer_point(d.transfer, *place, d.transfer[*place].value, plot.extinction_at(plot.mouse.y),
                                        gap_of(volume));
        },
        false);
    return place ? Target{point ? PlotKind::Point : PlotKind::Iso, *place} : Target{};
}

void drag(AppState& state, const ValuePlot& plot) {
    PlotState& now = state.editing.plot;
    const auto& volume = state.session.volume();
    const glm::dvec2 to = plot.mouse - now.offset;
    state.session.edit(
        [&](SceneDocument& d) {
            if (now.grabbed.kind == PlotKind::Iso)
                now.grabbed.place = viewer::move_iso_value(d, volume, now.grabbed.place, snapped(state, plot, to.x));
            else
                viewer::move_transfer_point(d.transfer, now.grabbed.place, plot.value_at(to.x),
                                            plot.extinction_at(to.y), gap_of(volume));
        },
        false);
}

void take_away(AppState& state, const Target& target) {
    bool gone = false;
    state.session.edit([&](SceneDocument& d) {
        gone = target.kind == PlotKind::Iso ? viewer::remove_iso_value(d, target.place)
                                            : viewer::remove_transfer_point(d.transfer, target.place);
    });
    if (!gone) state.session.say("the last one cannot be removed");
    if (gone && target.kind == PlotKind::Point) state.editing.plot.chosen.reset();
}

bool there(const AppState& state, const Target& target) {
    const SceneDocument& document = state.session.document();
    return (target.kind == PlotKind::Iso && target.place < document.iso_values.size()) ||
           (target.kind == PlotKind::Point && target.place < document.transfer.size());
}

void mouse(AppState& state, const ValuePlot& plot, const Target& under) {
    PlotState& now = state.editing.plot;
    if (plot.right && under.kind != PlotKind::None) take_away(state, under);
    if (plot.pressed) {
        now.grabbed = under;
        now.offset = under.kind == PlotKind::None ? glm::dvec2(0) : plot.mouse - place_of(state, plot, under);
        if (plot.twice && under.kind == PlotKind::None) now.grabbed = added(state, plot);
        if (now.grabbed.kind == PlotKind::Point) now.chosen = now.grabbed.place;
    }
    if (!plot.held || !there(state, now.grabbed)) now.grabbed = {};
    const ImVec2 way = ImGui::GetIO().MouseDelta;
    if (now.grabbed.kind != PlotKind::None && !plot.pressed && (way.x != 0 || way.y != 0)) drag(state, plot);
}

void tooltip(const AppState& state, const ValuePlot& plot, const Target& target) {
    const SceneDocument& document = state.session.document();
    if (target.kind == PlotKind::Iso) {
        ImGui::SetTooltip("iso-value %.10g", document.iso_values[target.place]);
    } else if (target.kind == PlotKind::Point) {
        const auto& point = document.transfer[target.place];
        ImGui::SetTooltip("%.10g: %g per mm", point.value, point.extinction);
    } else {
        ImGui::SetTooltip("%.10g", plot.value_at(plot.mouse.x));
    }
}

void visible_range(AppState& state) {
    PlotState& now = state.editing.plot;
    const auto& volume = state.session.volume();
    const float low = volume.min_value, high = volume.max_value;
    // Floats hold values in the unit of the samples, but perhaps not in the file's.
    auto from = static_cast<float>(now.low / volume.value_scale),
         to = static_cast<float>(now.high / volume.value_scale);
    ImGui::SetNextItemWidth(14 * static_cast<float>(state.em));
    if (ImGui::DragFloatRange2("##range", &from, &to, (high - low) / 400, low, high, "from %g", "to %g",
                               ImGuiSliderFlags_AlwaysClamp) &&
        static_cast<double>(to - from) > 1e-3 * static_cast<double>(high - low)) {
        now.low = volume.in_file_unit(static_cast<double>(from));
        now.high = volume.in_file_unit(static_cast<double>(to));
    }
    note(state, "range");
    ImGui::SameLine();
    if (!button(state, "reset")) return;
    now.low = volume.in_file_unit(static_cast<double>(low));
    now.high = volume.in_file_unit(static_cast<double>(high));
}

}  // namespace

void histogram_panel(AppState& state) {
    const auto& volume = state.session.volume();
    if (!(volume.max_value > volume.min_value)) {
        ImGui::TextDisabled("every voxel has the value %s", edgesplat::value_text(volume, volume.min_value).c_str());
        return;
    }
    const ValuePlot plot = value_plot(state, "histogram");
    PlotState& now = state.editing.plot;
    const Target under = plot.hovered ? target_at(state, plot) : Target{};
    mouse(state, plot, under);
    const Target bright = now.grabbed.kind == PlotKind::None ? target_at(state, plot) : now.grabbed;
    const auto is = [&](PlotKind kind, std::size_t i) {
        return (plot.hovered || plot.held) && bright.kind == kind && bright.place == i;
    };
    const SceneDocument& document = state.session.document();
    plot.list->PushClipRect(ImGui::GetItemRectMin(), ImGui::GetItemRectMax(), true);
    paint_transfer(plot, document.transfer);
    for (std::size_t i = 0; i < document.iso_values.size(); ++i) {
        const auto& material = state.session.scene().materials.at(i + 1);
        paint_iso(plot, document.iso_values[i], document.transfer.empty() ? material.color : glm::dvec3(0.8),
                  is(PlotKind::Iso, i));
    }
    for (std::size_t i = 0; i < document.transfer.size(); ++i)
        paint_point(plot, document.transfer[i], now.chosen == i || is(PlotKind::Point, i), state.em);
    plot.list->PopClipRect();
    if (plot.hovered || plot.held) tooltip(state, plot, bright);
    visible_range(state);
}
