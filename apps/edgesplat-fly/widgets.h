// Widgets for the scene document. They change it through the session; all changes during one mouse press are one undo
// step.
#pragma once

#include <functional>
#include <string>

#include "apps/edgesplat-fly/app_state.h"

/// A part of a panel: it prefixes its widgets' identifiers, and their names in scripts ("light0.intensity").
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

/// Stores a widget's rectangle for scripts. Without `corners`: that of the last widget, if it is visible. Its name is
/// the label before "##", or after it if nothing precedes it, with underscores for spaces.
void note(AppState& state, const std::string& name, const std::array<glm::dvec2, 2>& corners);
void note(AppState& state, const char* label);

/// Range and format of a slider.
struct SlideRange {
    double low = 0, high = 1;
    const char* format = "%.2f";
    bool logarithmic = false;
};

template <typename T>
using Setter = std::function<void(edgesplat::SceneDocument&, const T&)>;

void slide(AppState& state, const char* label, double value, const SlideRange& range, const Setter<double>& set);
void slide(AppState& state, const char* label, int value, int low, int high, const Setter<int>& set);
/// Three numbers; `speed`: change per pixel.
void drag3(AppState& state, const char* label, const glm::dvec3& value, double speed, const Setter<glm::dvec3>& set);
void flag(AppState& state, const char* label, bool value, const Setter<bool>& set);
/// A swatch that opens a colour picker. The value is linear light, edited as sRGB.
void color(AppState& state, const char* label, const glm::dvec3& linear, const Setter<glm::dvec3>& set);
bool button(AppState& state, const char* label);

/// Linear light as a colour of Dear ImGui.
unsigned painted(const glm::dvec3& linear, double alpha = 1);
