// Plays a script: provides the user input of one frame at a time.
#pragma once

#include <deque>
#include <functional>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include "apps/edgesplat-fly/input.h"
#include "engine/viewer/script.h"

/// What the app does for a script, besides processing its input.
struct ScriptHost {
    std::function<void(const std::string& path)> open;  ///< returns when it is loaded
    std::function<bool()> settled;                      ///< no better picture will follow
    std::function<void(const std::string&path)> screenshot, picture, save, report;
    std::function<void(bool fixed)> fix_quality;
    std::function<void(bool window)> simulate_device_loss;  ///< of the window's device, else of the pictures' device
    std::function<glm::dvec4(const std::string& name)> widget;  ///< its rectangle; throws Error if it is not visible
    std::function<std::string(const std::string& name)> value;  ///< for `expect`; throws Error for an unknown name
};

class ScriptPlayer {
  public:
    ScriptPlayer(std::vector<edgesplat::viewer::ScriptCommand> commands, ScriptHost host, const glm::ivec2& size);
    /// The next frame's input; nullopt at the end. Throws Error if an `expect` is false.
    std::optional<Input> next();

  private:
    using Change = std::function<void(Input&)>;
    void begin(const edgesplat::viewer::ScriptCommand& command);
    void expect(const edgesplat::viewer::ScriptCommand& command) const;
    void aim(const edgesplat::viewer::ScriptCommand& command, const glm::dvec2& share);
    void wander(double seconds, unsigned seed);
    void frame(Change change = {}) { pending_.push_back(std::move(change)); }

    std::vector<edgesplat::viewer::ScriptCommand> commands_;
    ScriptHost host_;
    std::size_t at_ = 0;
    Input input_;
    std::deque<Change> pending_;
    bool settling_ = false;
    int settle_frames_ = 0;
};
