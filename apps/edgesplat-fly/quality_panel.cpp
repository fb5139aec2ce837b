#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <array>
#include <map>

#include "apps/edgesplat-fly/panels.h"
#include "engine/scene/ladder.h"

namespace {

using edgesplat::Knob;
using edgesplat::SceneDocument;
using edgesplat::Settings;

/// Sets a knob. Returns whether it accepts the value.
bool set(Settings& settings, const Knob& knob, const std::string& value) {
    try {
        knob.set(settings, value);
        return true;
    } catch (const edgesplat::Error&) {
        return false;
    }
}

void step_slider(AppState& state, const Knob& knob) {
    const Settings& now = state.session.document().quality.settings;
    const std::string value = knob.get(now), name(knob.name);
    auto steps = knob.steps;
    steps.insert(steps.end(), knob.others.begin(), knob.others.end());
    const auto at = std::ranges::find(steps, value);
    int index = at == steps.end() ? -1 : static_cast<int>(at - steps.begin());
    const bool moved = ImGui::SliderInt(name.c_str(), &index, 0, static_cast<int>(steps.size()) - 1, value.c_str());
    const bool finished = ImGui::IsItemDeactivatedAfterEdit();
    if (ImGui::IsItemHovered()) ImGui::SetTooltip("%s", std::string(knob.help).c_str());
    if ((!moved && !finished) || index < 0) return;
    const std::string chosen(steps[static_cast<std::size_t>(index)]);
    state.session.edit(
        [&](SceneDocument& d) {
            if (set(d.quality.settings, knob, chosen)) d.quality.preset.clear();
        },
        finished);
}

void presets(AppState& state) {
    const auto apply = [&](const std::string& name, const Settings& settings) {
        state.session.edit([&](SceneDocument& d) {
            d.quality.preset = name;
            d.quality.settings = settings;
        });
    };
    if (ImGui::Button("fast")) apply("", Settings{});
    for (const edgesplat::Preset& preset : edgesplat::presets()) {
        ImGui::SameLine();
        if (ImGui::Button(std::string(preset.name).c_str())) apply(std::string(preset.name), preset.settings);
        if (ImGui::IsItemHovered()) ImGui::SetTooltip("%s", std::string(preset.help).c_str());
    }
}

void pass_times(const AppState& state) {
    if (!state.shown) return;
    const auto& stats = state.shown->stats;
    std::map<std::string, double> sums;
    double most = 0;
    for (const auto& pass : stats.passes)
        most = std::max(most, sums[pass.name] += pass.milliseconds);
    for (const auto& [name, milliseconds] : sums) {
        const std::string text = fmt::format("{} {:.1f} ms", name, milliseconds);
        ImGui::ProgressBar(most > 0 ? static_cast<float>(milliseconds / most) : 0, {-1, 0}, text.c_str());
    }
    ImGui::TextDisabled("%s of %s splats drawn, %u sheets", fmt::format("{}", stats.splats_drawn).c_str(),
                        fmt::format("{}", stats.splats_collected).c_str(), stats.sheets);
    ImGui::TextDisabled("%.0f MB on the device", static_cast<double>(state.drawer->device_bytes()) / 1e6);
}

void device_choice(AppState& state) {
    const std::string current = state.shown ? state.shown->stats.device.name : std::string("device");
    if (!ImGui::BeginCombo("device", current.c_str())) return;
    for (const edgesplat::DeviceInfo& device : state.devices) {
        const std::string label = fmt::format("{}: {}", device.index, device.name);
        if (!device.rejections.empty()) {
            ImGui::TextDisabled("%s: %s", label.c_str(), device.rejections.front().c_str());
        } else if (ImGui::Selectable(label.c_str(), device.name == current)) {
            state.pending_requests.device = device.name;
        }
    }
    ImGui::EndCombo();
}

}  // namespace

void quality_panel(AppState& state) {
    if (!state.session.is_open()) return;
    presets(state);
    const Settings now = state.session.document().quality.settings;  // a copy: an edit replaces the document
    for (const Knob& knob : edgesplat::ladder())
        if (knob.used(now)) step_slider(state, knob);
    bool best = state.session.best_when_still();
    if (ImGui::Checkbox("accurate when nothing moves", &best)) state.session.set_best_when_still(best);
    constexpr std::array<const char*, 4> kRays{"splats", "rays without a GPU", "rays", "rays, B-spline"};
    int rays = static_cast<int>(state.rays);
    if (ImGui::Combo("in motion", &rays, kRays.data(), static_cast<int>(kRays.size()))) {
        state.rays = static_cast<edgesplat::viewer::Drawer::Options::Rays>(rays);
        state.drawer->set_rays(state.rays);
    }
    auto target = static_cast<float>(state.target);
    if (ImGui::SliderFloat("ms in motion", &target, 5, 1000, "%.0f", ImGuiSliderFlags_Logarithmic)) {
        state.target = state.preferences.target = static_cast<double>(target);
        state.drawer->set_target(state.target);
    }
    pass_times(state);
    device_choice(state);
}
