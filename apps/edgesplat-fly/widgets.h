// Widgets on the scene's document: what they change goes through the session, and all that one hold of the mouse
// changes is one step back.
#pragma once

#include <functional>
#include <string>

#include "apps/edgesplat-fly/app_state.h"

/// A part of a panel: its widgets' identifiers, and their names for scripts ("light0.intensity").
class Scope {
  public:
    Scope(AppState& state, const std::string& name);
    ~Scope();
    Scope(const Scope&) = delete;
    Scope& operator=(const Scope&) = delete;

  private:
    AppState& state_;
    std::size_t length_;
};

/// Remembers where a widget is, so that scripts find it. Without a rectangle, the one that was just made, if it can be
/// seen; of its label only what stands before "##", with underscores for spaces, or else what stands behind.
void note(AppState& state, const std::string& name, const std::array<glm::dvec2, 2>& corners);
void note(AppState& state, const char* label);

/// What numbers a slider offers.
struct SlideRange {
    double low = 0, high = 1;
    const char* format = "%.2f";
    bool logarithmic = false;
};

template <typename T>
using Setter = std::function<void(edgesplat::SceneDocument&, const T&)>;

void slide(AppState& state, const char* label, double value, const SlideRange& range, const Setter<double>& set);
void slide(AppState& state, const char* label, int value, int low, int high, const Setter<int>& set);
/// Three numbers; `speed` a pixel.
void drag3(AppState& state, const char* label, const glm::dvec3& value, double speed, const Setter<glm::dvec3>& set);
void flag(AppState& state, const char* label, bool value, const Setter<bool>& set);
/// Linear light, picked as sRGB. A swatch that opens a picker.
void color(AppState& state, const char* label, const glm::dvec3& linear, const Setter<glm::dvec3>& set);
bool button(AppState& state, const char* label);

/// Linear light as Dear ImGui paints it.
unsigned painted(const glm::dvec3& linear, double alpha = 1);
