// User input since the last frame: mouse, keyboard and gamepad, from a window or from a script.
#pragma once

#include <array>
#include <glm/glm.hpp>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

/// Keys by name ("W", "Home", "F1"), as scripts and the help spell them.
using Key = std::string;

enum class Button { Left, Right, Middle };

struct Gamepad {
    glm::dvec2 left{0}, right{0};  ///< sticks: right, up, -1..1
    double rise = 0;               ///< triggers: right minus left; buttons are keys: PadA, PadB, PadX, PadY, PadStart
};

struct Input {
    double seconds = 1.0 / 60;   ///< since the last frame
    glm::ivec2 size{1280, 800};  ///< of the window's content, pixels; 0 while it is minimised
    glm::dvec2 mouse{-1e6};      ///< pixels from the top left corner
    std::array<bool, 3> buttons{};
    double wheel = 0;                  ///< steps, > 0 away from the user
    std::set<Key> held;                ///< keys that are down
    std::vector<Key> pressed;          ///< pressed since the last frame, repeats included
    std::u32string text;               ///< typed text
    std::vector<std::string> dropped;  ///< dropped paths
    Gamepad gamepad;
    bool close = false;

    bool down(Button button) const { return buttons[static_cast<std::size_t>(button)]; }
    bool holds(std::string_view key) const { return held.contains(Key(key)); }
    bool shift() const { return holds("Shift"); }
    bool ctrl() const { return holds("Ctrl"); }
};

/// Whether a key of that name exists.
bool is_key(std::string_view name);
/// The name of a gamepad's button by GLFW's number; empty: none.
std::string_view pad_button_name(int button);
/// The name of a GLFW key code; empty: none.
std::string_view key_name(int code);
