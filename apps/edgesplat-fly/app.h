// The navigation app. Each frame processes input, session, picture and panels, in this order.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "apps/edgesplat-fly/app_state.h"
#include "apps/edgesplat-fly/controls.h"
#include "apps/edgesplat-fly/frame_times.h"
#include "apps/edgesplat-fly/script_player.h"
#include "apps/edgesplat-fly/script_recorder.h"
#include "apps/edgesplat-fly/surface.h"
#include "apps/edgesplat-fly/window.h"

/// The names of all values that scripts can compare, separated by commas.
std::string value_names();

struct AppOptions {
    std::string source;  ///< volume or scene file; empty: a builtin scene
    edgesplat::DeviceChoice device;
    std::string script, record;
    bool headless = false;  ///< no window: a script provides the input
    bool remember = true;   ///< read and write the user's preferences
    glm::ivec2 size{0};     ///< of the content; 0: as last time
    double target = 0;  ///< time limit of a picture in motion, milliseconds; 0: as last time, else chosen by the device
    std::uint64_t memory_budget = 0;
};

class App {
  public:
    explicit App(const AppOptions& options);
    ~App();
    App(const App&) = delete;
    App& operator=(const App&) = delete;
    void run();

  private:
    void open_gui();
    void close_gui();
    void load_font();
    void make_drawer();
    void frame(const Input& input);
    void lay_out(const Input& input);
    void show_panels();
    void present();
    void apply_requests();
    void begin_loading(const std::string& path);
    void finish_loading();
    void finish_writing(bool wait);
    ScriptHost script_host();
    std::string value(const std::string& name);
    bool is_busy() const;
    std::optional<Input> next_input();

    AppOptions options_;
    AppState state_;
    std::unique_ptr<Window> window_;
    std::unique_ptr<edgesplat::gpu::Device> device_;
    std::unique_ptr<Canvas> canvas_;
    std::unique_ptr<Surface> surface_;
    std::unique_ptr<ScriptPlayer> player_;
    std::unique_ptr<ScriptRecorder> recorder_;
    PictureControls controls_;
    FrameTimes times_;
    glm::ivec2 size_{1280, 800};
    bool leaving_ = false;
    bool lose_window_ = false;
    int lost_ = 0;                ///< consecutive losses of devices
    std::uint64_t messages_ = 0;  ///< validation messages of destroyed devices
};
