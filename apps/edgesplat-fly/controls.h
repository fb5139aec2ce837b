// Turns user input on the picture into actions. One table lists all keys with their actions; the help shows it.
#pragma once

#include <span>
#include <string_view>

#include "apps/edgesplat-fly/app_state.h"

/// A key, optionally with "Ctrl+" before it, and its action.
struct Shortcut {
    std::string_view keys;
    std::string_view what;
    void (*act)(AppState&);  ///< null: held rather than pressed, or a mouse action
};
std::span<const Shortcut> shortcuts();

/// Starts or stops recording the flight, with a message.
void toggle_recording(AppState& state);

/// Handles mouse, keys and gamepad of one frame.
class PictureControls {
  public:
    /// Carries out shortcuts, picks and drags, and returns the controls that move the eye. `over_picture`: the mouse is
    /// on the picture and on no panel. `typing`: a text field receives the keys.
    edgesplat::viewer::Controls apply(AppState& state, const Input& input, bool over_picture, bool typing);

  private:
    void mouse(AppState& state, const Input& input, bool over_picture, edgesplat::viewer::Controls& controls);
    void click(AppState& state, const glm::dvec2& pixel, bool twice, bool picking);

    enum class Drag { None, Orbit, Pan, Look, Wipe };
    Drag drag_ = Drag::None;
    bool was_down_ = false;
    glm::dvec2 last_{0}, pressed_at_{0};
    double travelled_ = 0;      ///< pixels since the button was pressed
    double since_click_ = 1e9;  ///< seconds
    glm::dvec2 clicked_at_{-1e6};
};
