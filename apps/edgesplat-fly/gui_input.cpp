#include "apps/edgesplat-fly/gui_input.h"

#include <imgui.h>

#include <algorithm>
#include <array>
#include <utility>

namespace {

/// The keys that text fields and menus use.
constexpr std::array<std::pair<std::string_view, int>, 19> kKeys{{{"Tab", ImGuiKey_Tab},
                                                                  {"Left", ImGuiKey_LeftArrow},
                                                                  {"Right", ImGuiKey_RightArrow},
                                                                  {"Up", ImGuiKey_UpArrow},
                                                                  {"Down", ImGuiKey_DownArrow},
                                                                  {"PageUp", ImGuiKey_PageUp},
                                                                  {"PageDown", ImGuiKey_PageDown},
                                                                  {"Home", ImGuiKey_Home},
                                                                  {"End", ImGuiKey_End},
                                                                  {"Delete", ImGuiKey_Delete},
                                                                  {"Backspace", ImGuiKey_Backspace},
                                                                  {"Enter", ImGuiKey_Enter},
                                                                  {"Escape", ImGuiKey_Escape},
                                                                  {"A", ImGuiKey_A},
                                                                  {"C", ImGuiKey_C},
                                                                  {"V", ImGuiKey_V},
                                                                  {"X", ImGuiKey_X},
                                                                  {"Y", ImGuiKey_Y},
                                                                  {"Z", ImGuiKey_Z}}};

}  // namespace

void prepare_gui_input() {
#if IMGUI_VERSION_NUM < 18700
    // The key codes are indices into the table.
    for (std::size_t i = 0; i < kKeys.size(); ++i)
        ImGui::GetIO().KeyMap[kKeys[i].second] = static_cast<int>(i);
#endif
}

void feed_gui(const Input& input) {
    ImGuiIO& io = ImGui::GetIO();
    io.DeltaTime = static_cast<float>(input.seconds);
    io.DisplaySize = {static_cast<float>(input.size.x), static_cast<float>(input.size.y)};
    const auto down = [&](std::string_view key) {
        return input.holds(key) || std::ranges::find(input.pressed, key) != input.pressed.end();
    };
#if IMGUI_VERSION_NUM < 18700
    io.MousePos = {static_cast<float>(input.mouse.x), static_cast<float>(input.mouse.y)};
    for (std::size_t b = 0; b < input.buttons.size(); ++b)
        io.MouseDown[b] = input.buttons[b];
    io.MouseWheel = static_cast<float>(input.wheel);
    for (std::size_t i = 0; i < kKeys.size(); ++i)
        io.KeysDown[i] = down(kKeys[i].first);
    io.KeyCtrl = input.ctrl();
    io.KeyShift = input.shift();
    io.KeyAlt = input.holds("Alt");
#else
    io.AddMousePosEvent(static_cast<float>(input.mouse.x), static_cast<float>(input.mouse.y));
    for (std::size_t b = 0; b < input.buttons.size(); ++b)
        io.AddMouseButtonEvent(static_cast<int>(b), input.buttons[b]);
    if (input.wheel != 0) io.AddMouseWheelEvent(0, static_cast<float>(input.wheel));
    for (const auto& [name, key] : kKeys)
        io.AddKeyEvent(static_cast<ImGuiKey>(key), down(name));
    io.AddKeyEvent(ImGuiMod_Ctrl, input.ctrl());
    io.AddKeyEvent(ImGuiMod_Shift, input.shift());
    io.AddKeyEvent(ImGuiMod_Alt, input.holds("Alt"));
#endif
    for (const char32_t c : input.text)
        io.AddInputCharacter(static_cast<unsigned>(c));
}
