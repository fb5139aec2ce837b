// From what a person did in the picture to what becomes of it. Which key does what stands in one table, which the help
// shows.
#pragma once

#include <span>
#include <string_view>

#include "apps/edgesplat-fly/app_state.h"

/// A key, with "Ctrl+" before it, and what it does.
struct Shortcut {
    std::string_view keys;
    std::string_view what;
    void (*act)(AppState&);  ///< null: held rather than pressed, or done with the mouse
};
std::span<const Shortcut> shortcuts();

/// Begins to record the flight, or ends it, and says so.
void toggle_recording(AppState& state);

/// Mouse, keys and gamepad of one frame.
class PictureControls {
  public:
    /// Carries out shortcuts, picks and drags, and returns what moves the eye. `over_picture`: the mouse is on the
    /// picture and no panel; `typing`: a text field takes the keys.
    edgesplat::viewer::Controls apply(AppState& state, const Input& input, bool over_picture, bool typing);

  private:
    void mouse(AppState& state, const Input& input, bool over_picture, edgesplat::viewer::Controls& controls);
    void click(AppState& state, const glm::dvec2& pixel, bool twice, bool picking);

    enum class Drag { None, Orbit, Pan, Look, Wipe };
    Drag drag_ = Drag::None;
    bool was_down_ = false;
    glm::dvec2 last_{0}, pressed_at_{0};
    double travelled_ = 0;      ///< pixels since the button went down
    double since_click_ = 1e9;  ///< seconds
    glm::dvec2 clicked_at_{-1e6};
};
