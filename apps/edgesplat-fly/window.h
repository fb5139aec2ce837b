// The window on the screen: what is done in it, and how its content gets there.
#pragma once

#include <deque>
#include <string>
#include <vector>

#include "apps/edgesplat-fly/input.h"

struct GLFWwindow;

class Window {
  public:
    /// Throws Error where there is no screen.
    Window(const glm::ivec2& size, const std::string& title);
    ~Window();
    Window(const Window&) = delete;
    Window& operator=(const Window&) = delete;

    /// What the device needs to draw to it.
    static std::vector<const char*> instance_extensions();
    GLFWwindow* handle() const { return window_; }
    /// What happened since the last call; waits at most so long for something to happen.
    Input poll(double wait);
    /// The screen's factor on the size of text.
    double content_scale() const;
    void set_title(const std::string& title);
    void set_full_screen(bool on);
    bool full_screen() const { return full_screen_; }
    /// For Dear ImGui, which copies and pastes.
    static void install_clipboard(GLFWwindow* window);

  private:
    /// A key or a mouse button that went down or came up.
    struct Event {
        Key key;  ///< empty: a button
        Button button = Button::Left;
        bool down = false;
        glm::dvec2 at{0};  ///< of the mouse then, window coordinates
    };
    void read_gamepad();
    std::optional<glm::dvec2> take_events();
    static void on_key(GLFWwindow* window, int code, int scancode, int action, int modifiers);
    static void on_button(GLFWwindow* window, int button, int action, int modifiers);
    static Window& of(GLFWwindow* window);
    GLFWwindow* window_ = nullptr;
    Input input_;
    std::deque<Event> events_;  ///< that no frame has seen yet
    double last_ = 0;
    bool full_screen_ = false;
    glm::ivec4 windowed_{0};  ///< place and size before it filled the screen
};
