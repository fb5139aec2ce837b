#include "apps/edgesplat-fly/input.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include <algorithm>
#include <array>

namespace {

/// A key's name and GLFW's code of it. A modifier has an entry for each of its two keys.
struct KeyName {
    std::string_view name;
    int code;
};

constexpr std::array<KeyName, 36> kNamed{{{"Space", GLFW_KEY_SPACE},
                                          {"Enter", GLFW_KEY_ENTER},
                                          {"Enter", GLFW_KEY_KP_ENTER},
                                          {"Escape", GLFW_KEY_ESCAPE},
                                          {"Tab", GLFW_KEY_TAB},
                                          {"Backspace", GLFW_KEY_BACKSPACE},
                                          {"Delete", GLFW_KEY_DELETE},
                                          {"Home", GLFW_KEY_HOME},
                                          {"End", GLFW_KEY_END},
                                          {"PageUp", GLFW_KEY_PAGE_UP},
                                          {"PageDown", GLFW_KEY_PAGE_DOWN},
                                          {"Left", GLFW_KEY_LEFT},
                                          {"Right", GLFW_KEY_RIGHT},
                                          {"Up", GLFW_KEY_UP},
                                          {"Down", GLFW_KEY_DOWN},
                                          {"Shift", GLFW_KEY_LEFT_SHIFT},
                                          {"Shift", GLFW_KEY_RIGHT_SHIFT},
                                          {"Ctrl", GLFW_KEY_LEFT_CONTROL},
                                          {"Ctrl", GLFW_KEY_RIGHT_CONTROL},
                                          {"Alt", GLFW_KEY_LEFT_ALT},
                                          {"Alt", GLFW_KEY_RIGHT_ALT},
                                          {"Plus", GLFW_KEY_KP_ADD},
                                          {"Minus", GLFW_KEY_KP_SUBTRACT},
                                          {"Minus", GLFW_KEY_MINUS},
                                          {"F1", GLFW_KEY_F1},
                                          {"F2", GLFW_KEY_F2},
                                          {"F3", GLFW_KEY_F3},
                                          {"F4", GLFW_KEY_F4},
                                          {"F5", GLFW_KEY_F5},
                                          {"F6", GLFW_KEY_F6},
                                          {"F7", GLFW_KEY_F7},
                                          {"F8", GLFW_KEY_F8},
                                          {"F9", GLFW_KEY_F9},
                                          {"F10", GLFW_KEY_F10},
                                          {"F11", GLFW_KEY_F11},
                                          {"F12", GLFW_KEY_F12}}};

/// Buttons of a gamepad, with GLFW's numbers.
constexpr std::array<KeyName, 5> kPad{{{"PadA", GLFW_GAMEPAD_BUTTON_A},
                                       {"PadB", GLFW_GAMEPAD_BUTTON_B},
                                       {"PadX", GLFW_GAMEPAD_BUTTON_X},
                                       {"PadY", GLFW_GAMEPAD_BUTTON_Y},
                                       {"PadStart", GLFW_GAMEPAD_BUTTON_START}}};

/// Letters and digits: GLFW's codes are their ASCII codes.
constexpr std::string_view kPlain = "ABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789";

}  // namespace

bool is_key(std::string_view name) {
    return (name.size() == 1 && kPlain.find(name[0]) != std::string_view::npos) ||
           std::ranges::count(kNamed, name, &KeyName::name) + std::ranges::count(kPad, name, &KeyName::name) > 0;
}

std::string_view pad_button_name(int button) {
    const auto found = std::ranges::find(kPad, button, &KeyName::code);
    return found == kPad.end() ? std::string_view() : found->name;
}

std::string_view key_name(int code) {
    for (std::size_t i = 0; i < kPlain.size(); ++i)
        if (kPlain[i] == code) return kPlain.substr(i, 1);
    const auto found = std::ranges::find(kNamed, code, &KeyName::code);
    return found == kNamed.end() ? std::string_view() : found->name;
}
