// The navigation app: a frame is input, session, picture, panels, in this order.
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

/// What scripts may expect, with commas between.
std::string value_names();

struct AppOptions {
    std::string source;  ///< volume or scene file; empty: a builtin scene
    edgesplat::DeviceChoice device;
    std::string script, record;
    bool headless = false;  ///< no window: only a script drives it
    bool remember = true;   ///< read and write the user's preferences
    glm::ivec2 size{0};     ///< of the content; 0: as last time
    double target = 0;      ///< milliseconds in motion; 0: as last time, else by the device
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
    void grant_wishes();
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
    int lost_ = 0;                ///< devices in a row
    std::uint64_t messages_ = 0;  ///< of validation, by devices that are gone
};
