// The window on the screen: collects user input and provides the handle for drawing.
#pragma once

#include <deque>
#include <string>
#include <vector>

#include "apps/edgesplat-fly/input.h"

struct GLFWwindow;

class Window {
  public:
    /// Throws Error if there is no screen.
    Window(const glm::ivec2& size, const std::string& title);
    ~Window();
    Window(const Window&) = delete;
    Window& operator=(const Window&) = delete;

    /// Vulkan instance extensions for drawing to the window.
    static std::vector<const char*> instance_extensions();
    GLFWwindow* handle() const { return window_; }
    /// Input since the last call. Waits at most `wait` seconds for events.
    Input poll(double wait);
    /// The screen's scale factor for text.
    double content_scale() const;
    void set_title(const std::string& title);
    void set_full_screen(bool on);
    bool full_screen() const { return full_screen_; }
    /// Gives Dear ImGui access to the clipboard.
    static void install_clipboard(GLFWwindow* window);

  private:
    /// A key or a mouse button that was pressed or released.
    struct Event {
        Key key;  ///< empty: a mouse button
        Button button = Button::Left;
        bool down = false;
        glm::dvec2 at{0};  ///< mouse position at that time, window coordinates
    };
    void read_gamepad();
    std::optional<glm::dvec2> take_events();
    static void on_key(GLFWwindow* window, int code, int scancode, int action, int modifiers);
    static void on_button(GLFWwindow* window, int button, int action, int modifiers);
    static Window& of(GLFWwindow* window);
    GLFWwindow* window_ = nullptr;
    Input input_;
    std::deque<Event> events_;  ///< not yet passed to a frame
    double last_ = 0;
    bool full_screen_ = false;
    glm::ivec4 windowed_{0};  ///< position and size before full screen
};
