#include "apps/edgesplat-fly/window.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <imgui.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "engine/error.h"

namespace {

/// Value of a stick without the inner dead zone, where hands rest.
double stick(float value) {
    constexpr double kDead = 0.15;
    const double size = std::abs(static_cast<double>(value));
    return size < kDead ? 0 : std::copysign(std::min((size - kDead) / (1 - kDead), 1.0), static_cast<double>(value));
}

}  // namespace

Window& Window::of(GLFWwindow* window) {
    return *static_cast<Window*>(glfwGetWindowUserPointer(window));
}

void Window::on_key(GLFWwindow* window, int code, int /*scancode*/, int action, int /*modifiers*/) {
    const std::string_view name = key_name(code);
    if (!name.empty()) of(window).events_.push_back({Key(name), Button::Left, action != GLFW_RELEASE, {}});
}

void Window::on_button(GLFWwindow* window, int button, int action, int /*modifiers*/) {
    constexpr std::array<Button, 3> kButtons{Button::Left, Button::Right, Button::Middle};
    if (button < 0 || button >= static_cast<int>(kButtons.size())) return;
    Event event{{}, kButtons[static_cast<std::size_t>(button)], action == GLFW_PRESS, {}};
    glfwGetCursorPos(window, &event.at.x, &event.at.y);
    of(window).events_.push_back(event);
}

std::optional<glm::dvec2> Window::take_events() {
    // A press and a release between two frames go to two different frames, however slow these are.
    std::optional<glm::dvec2> at;
    bool went_down = false, came_up = false;
    for (; !events_.empty(); events_.pop_front()) {
        const Event& event = events_.front();
        if (event.down ? came_up : went_down) break;
        (event.down ? went_down : came_up) = true;
        if (event.key.empty()) {
            input_.buttons[static_cast<std::size_t>(event.button)] = event.down;
            at = event.at;
        } else if (event.down) {
            input_.held.insert(event.key);
            input_.pressed.push_back(event.key);
        } else {
            input_.held.erase(event.key);
        }
    }
    return at;
}

Window::Window(const glm::ivec2& size, const std::string& title) {
    static std::string reason;
    glfwSetErrorCallback([](int, const char* text) { reason = text; });
    if (glfwInit() == GLFW_FALSE)
        edgesplat::fail("window: no screen ({}); --script FILE --headless runs without one", reason);
    if (glfwVulkanSupported() == GLFW_FALSE) {
        glfwTerminate();
        edgesplat::fail(
            "window: Vulkan is not available ({}); install a driver (software driver on Debian: "
            "mesa-vulkan-drivers)",
            reason);
    }
    glfwWindowHint(GLFW_CLIENT_API, GLFW_NO_API);
    window_ = glfwCreateWindow(size.x, size.y, title.c_str(), nullptr, nullptr);
    if (window_ == nullptr) {
        glfwTerminate();
        edgesplat::fail("window: cannot open a window of {}x{} pixels ({})", size.x, size.y, reason);
    }
    glfwSetWindowSizeLimits(window_, 320, 240, GLFW_DONT_CARE, GLFW_DONT_CARE);
    glfwSetWindowUserPointer(window_, this);
    glfwSetKeyCallback(window_, &Window::on_key);
    glfwSetMouseButtonCallback(window_, &Window::on_button);
    glfwSetCharCallback(window_, [](GLFWwindow* w, unsigned int c) { of(w).input_.text.push_back(c); });
    glfwSetScrollCallback(window_, [](GLFWwindow* w, double, double y) { of(w).input_.wheel += y; });
    glfwSetWindowFocusCallback(window_, [](GLFWwindow* w, int focused) {
        if (focused == GLFW_FALSE) of(w).input_.held.clear();  // another window receives the releases
    });
    glfwSetDropCallback(window_, [](GLFWwindow* w, int count, const char** paths) {
        of(w).input_.dropped.insert(of(w).input_.dropped.end(), paths, paths + count);
    });
    last_ = glfwGetTime();
}

Window::~Window() {
    glfwDestroyWindow(window_);
    glfwTerminate();
}

std::vector<const char*> Window::instance_extensions() {
    std::uint32_t count = 0;
    const char** names = glfwGetRequiredInstanceExtensions(&count);
    if (names == nullptr) edgesplat::fail("window: Vulkan cannot draw to this screen");
    return {names, names + count};
}

void Window::read_gamepad() {
    input_.gamepad = {};
    GLFWgamepadstate state;
    for (int joystick = GLFW_JOYSTICK_1; joystick <= GLFW_JOYSTICK_LAST; ++joystick) {
        if (glfwGetGamepadState(joystick, &state) == GLFW_FALSE) continue;
        const auto trigger = [&](int axis) { return (static_cast<double>(state.axes[axis]) + 1) / 2; };
        Gamepad& pad = input_.gamepad;
        pad.left = {stick(state.axes[GLFW_GAMEPAD_AXIS_LEFT_X]), -stick(state.axes[GLFW_GAMEPAD_AXIS_LEFT_Y])};
        pad.right = {stick(state.axes[GLFW_GAMEPAD_AXIS_RIGHT_X]), -stick(state.axes[GLFW_GAMEPAD_AXIS_RIGHT_Y])};
        pad.rise = trigger(GLFW_GAMEPAD_AXIS_RIGHT_TRIGGER) - trigger(GLFW_GAMEPAD_AXIS_LEFT_TRIGGER);
        for (int button = 0; button <= GLFW_GAMEPAD_BUTTON_LAST; ++button) {
            const Key name(pad_button_name(button));
            if (name.empty()) continue;
            if (state.buttons[button] == GLFW_RELEASE)
                input_.held.erase(name);
            else if (input_.held.insert(name).second)
                input_.pressed.push_back(name);
        }
        return;
    }
}

Input Window::poll(double wait) {
    input_.pressed.clear();
    input_.text.clear();
    input_.dropped.clear();
    input_.wheel = 0;
    if (wait > 0 && events_.empty())
        glfwWaitEventsTimeout(wait);
    else
        glfwPollEvents();
    const double now = glfwGetTime();
    input_.seconds = std::clamp(now - last_, 1e-4, 0.25);
    last_ = now;
    glfwGetFramebufferSize(window_, &input_.size.x, &input_.size.y);
    if (glfwGetWindowAttrib(window_, GLFW_ICONIFIED) == GLFW_TRUE) input_.size = glm::ivec2(0);
    glm::ivec2 window_size(0);
    glfwGetWindowSize(window_, &window_size.x, &window_size.y);
    glfwGetCursorPos(window_, &input_.mouse.x, &input_.mouse.y);
    if (const auto at = take_events()) input_.mouse = *at;
    if (window_size.x > 0 && window_size.y > 0) input_.mouse *= glm::dvec2(input_.size) / glm::dvec2(window_size);
    read_gamepad();
    input_.close = glfwWindowShouldClose(window_) == GLFW_TRUE;
    return input_;
}

double Window::content_scale() const {
    float x = 1, y = 1;
    glfwGetWindowContentScale(window_, &x, &y);
    return std::clamp(static_cast<double>(std::max(x, y)), 0.5, 8.0);
}

void Window::set_title(const std::string& title) {
    glfwSetWindowTitle(window_, title.c_str());
}

void Window::set_full_screen(bool on) {
    if (on == full_screen_) return;
    GLFWmonitor* monitor = glfwGetPrimaryMonitor();
    const GLFWvidmode* mode = monitor != nullptr ? glfwGetVideoMode(monitor) : nullptr;
    if (mode == nullptr) return;
    if (on) {
        glfwGetWindowPos(window_, &windowed_.x, &windowed_.y);
        glfwGetWindowSize(window_, &windowed_.z, &windowed_.w);
        glfwSetWindowMonitor(window_, monitor, 0, 0, mode->width, mode->height, mode->refreshRate);
    } else {
        glfwSetWindowMonitor(window_, nullptr, windowed_.x, windowed_.y, windowed_.z, windowed_.w, 0);
    }
    full_screen_ = on;
}

void Window::install_clipboard(GLFWwindow* window) {
#if IMGUI_VERSION_NUM < 19110
    ImGuiIO& io = ImGui::GetIO();
    io.ClipboardUserData = window;
    io.GetClipboardTextFn = [](void* user) { return glfwGetClipboardString(static_cast<GLFWwindow*>(user)); };
    io.SetClipboardTextFn = [](void* user, const char* text) {
        glfwSetClipboardString(static_cast<GLFWwindow*>(user), text);
    };
#else
    (void)window;  // later versions use their own clipboard unless their platform table says otherwise
#endif
}
