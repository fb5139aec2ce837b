#include "apps/edgesplat-fly/window.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <imgui.h>

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "engine/error.h"

namespace {

Input& input_of(GLFWwindow* window) {
    return *static_cast<Input*>(glfwGetWindowUserPointer(window));
}

void on_key(GLFWwindow* window, int code, int, int action, int) {
    const std::string_view name = key_name(code);
    if (name.empty()) return;
    Input& input = input_of(window);
    if (action == GLFW_RELEASE) {
        input.held.erase(Key(name));
        return;
    }
    input.held.insert(Key(name));
    input.pressed.emplace_back(name);
}

/// Inner dead zone of a stick, where hands rest.
double stick(float value) {
    constexpr double kDead = 0.15;
    const double size = std::abs(static_cast<double>(value));
    return size < kDead ? 0 : std::copysign(std::min((size - kDead) / (1 - kDead), 1.0), static_cast<double>(value));
}

}  // namespace

Window::Window(const glm::ivec2& size, const std::string& title) {
    static std::string reason;
    glfwSetErrorCallback([](int, const char* text) { reason = text; });
    if (glfwInit() == GLFW_FALSE)
        edgesplat::fail("window: no screen to open one on ({}); --script FILE --headless needs none", reason);
    if (glfwVulkanSupported() == GLFW_FALSE) {
        glfwTerminate();
        edgesplat::fail(
            "window: no Vulkan here ({}); a driver is needed (software driver on Debian: "
            "mesa-vulkan-drivers)",
            reason);
    }
    glfwWindowHint(GLFW_CLIENT_API, GLFW_NO_API);
    window_ = glfwCreateWindow(size.x, size.y, title.c_str(), nullptr, nullptr);
    if (window_ == nullptr) {
        glfwTerminate();
        edgesplat::fail("window: none of {}x{} could be opened ({})", size.x, size.y, reason);
    }
    glfwSetWindowSizeLimits(window_, 320, 240, GLFW_DONT_CARE, GLFW_DONT_CARE);
    glfwSetWindowUserPointer(window_, &input_);
    glfwSetKeyCallback(window_, &on_key);
    glfwSetCharCallback(window_, [](GLFWwindow* w, unsigned int c) { input_of(w).text.push_back(c); });
    glfwSetScrollCallback(window_, [](GLFWwindow* w, double, double y) { input_of(w).wheel += y; });
    glfwSetMouseButtonCallback(window_, [](GLFWwindow* w, int button, int action, int) {
        if (button < 3) input_of(w).buttons[static_cast<std::size_t>(button)] = action == GLFW_PRESS;
    });
    glfwSetWindowFocusCallback(window_, [](GLFWwindow* w, int focused) {
        if (focused == GLFW_FALSE) input_of(w).held.clear();  // releases go to whoever has the focus now
    });
    glfwSetDropCallback(window_, [](GLFWwindow* w, int count, const char** paths) {
        input_of(w).dropped.insert(input_of(w).dropped.end(), paths, paths + count);
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
        pad.home = state.buttons[GLFW_GAMEPAD_BUTTON_Y] == GLFW_PRESS;
        pad.toggle = state.buttons[GLFW_GAMEPAD_BUTTON_X] == GLFW_PRESS;
        return;
    }
}

Input Window::poll(double wait) {
    input_.pressed.clear();
    input_.text.clear();
    input_.dropped.clear();
    input_.wheel = 0;
    if (wait > 0)
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
    (void)window;  // later versions keep a clipboard of their own until told otherwise through their platform table
#endif
}
