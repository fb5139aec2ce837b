#include "apps/edgesplat-fly/widgets.h"

#include <imgui.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "engine/image/srgb.h"

namespace {

using edgesplat::to_linear;
using edgesplat::to_srgb;

std::string name_of(std::string label) {
    const auto hidden = label.find("##");
    if (hidden == 0) label = label.substr(label.find_first_not_of('#'));
    if (hidden != 0 && hidden != std::string::npos) label.resize(hidden);
    std::ranges::replace(label, ' ', '_');
    return label;
}

/// Notes the field without the label beside it.
void note_field(AppState& state, const char* label, float width) {
    if (!ImGui::IsItemVisible()) return;
    const ImVec2 low = ImGui::GetItemRectMin(), high = ImGui::GetItemRectMax();
    note(state, name_of(label), {glm::dvec2(low.x, low.y), glm::dvec2(low.x + width, high.y)});
}

template <typename T>
void change(AppState& state, const T& value, const Setter<T>& set) {
    state.session.edit([&](edgesplat::SceneDocument& d) { set(d, value); }, false);
}

}  // namespace

Scope::Scope(AppState& state, const std::string& name) : state_(state), length_(state.scope.size()) {
    ImGui::PushID(name.c_str());
    state_.scope += name + ".";
}

Scope::~Scope() {
    state_.scope.resize(length_);
    ImGui::PopID();
}

void note(AppState& state, const std::string& name, const std::array<glm::dvec2, 2>& corners) {
    state.places[state.scope + name] = {corners[0], corners[1]};
}

void note(AppState& state, const char* label) {
    if (!ImGui::IsItemVisible()) return;
    const ImVec2 low = ImGui::GetItemRectMin(), high = ImGui::GetItemRectMax();
    note(state, name_of(label), {glm::dvec2(low.x, low.y), glm::dvec2(high.x, high.y)});
}

void slide(AppState& state, const char* label, double value, const SlideRange& range, const Setter<double>& set) {
    const float width = ImGui::CalcItemWidth();
    const auto flags = range.logarithmic ? ImGuiSliderFlags_Logarithmic | ImGuiSliderFlags_NoRoundToFormat : 0;
    if (ImGui::SliderScalar(label, ImGuiDataType_Double, &value, &range.low, &range.high, range.format, flags))
        change(state, value, set);
    note_field(state, label, width);
}

void slide(AppState& state, const char* label, int value, int low, int high, const Setter<int>& set) {
    const float width = ImGui::CalcItemWidth();
    if (ImGui::SliderInt(label, &value, low, high)) change(state, std::clamp(value, low, high), set);
    note_field(state, label, width);
}

void drag3(AppState& state, const char* label, const glm::dvec3& value, double speed, const Setter<glm::dvec3>& set) {
    const float width = ImGui::CalcItemWidth();
    glm::dvec3 v = value;
    if (ImGui::DragScalarN(label, ImGuiDataType_Double, &v.x, 3, static_cast<float>(speed), nullptr, nullptr, "%.2f"))
        change(state, v, set);
    note_field(state, label, width);
}

void flag(AppState& state, const char* label, bool value, const Setter<bool>& set) {
    const bool clicked = ImGui::Checkbox(label, &value);
    note(state, label);
    if (clicked) state.session.edit([&](edgesplat::SceneDocument& d) { set(d, value); });
}

void color(AppState& state, const char* label, const glm::dvec3& linear, const Setter<glm::dvec3>& set) {
    std::array<float, 3> srgb{};
    for (int c = 0; c < 3; ++c)
        srgb[static_cast<std::size_t>(c)] = static_cast<float>(to_srgb(linear[c]));
    const bool changed = ImGui::ColorEdit3(label, srgb.data(), ImGuiColorEditFlags_NoInputs);
    note(state, label);
    if (!changed) return;
    glm::dvec3 out;
    for (int c = 0; c < 3; ++c)
        out[c] = std::clamp(to_linear(static_cast<double>(srgb[static_cast<std::size_t>(c)])), 0.0, 1.0);
    change(state, out, set);
}

bool button(AppState& state, const char* label) {
    const bool pressed = ImGui::Button(label);
    note(state, label);
    return pressed;
}

unsigned painted(const glm::dvec3& linear, double alpha) {
    const auto byte = [](double share) { return static_cast<int>(std::lround(255 * std::clamp(share, 0.0, 1.0))); };
    return IM_COL32(byte(to_srgb(linear.x)), byte(to_srgb(linear.y)), byte(to_srgb(linear.z)), byte(alpha));
}
