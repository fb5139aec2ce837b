// The user's preferences of the navigation app, kept between runs.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace edgesplat::viewer {

struct Preferences {
    std::vector<std::string> recent;  ///< opened files, most recent first; at most kMostRecent
    int width = 1280, height = 800;   ///< of the window, pixels
    double target = 0;                ///< time limit of a picture in motion, milliseconds; 0: chosen by the device
    double turn = 1, speed = 1;       ///< factors on the speed of turning and flying
    double text_scale = 0;            ///< factor on the size of text; 0: chosen by the screen
    bool collisions = true;
    bool invert_look = false;
    std::string device;  ///< see DeviceChoice
    bool operator==(const Preferences&) const = default;
};

inline constexpr std::size_t kMostRecent = 12;

/// $XDG_CONFIG_HOME/edgesplat/fly.toml or ~/.config/edgesplat/fly.toml; empty if neither folder is known.
std::filesystem::path preferences_path();

/// Reads the preferences. Missing or invalid entries have their defaults; an unreadable file counts as empty.
Preferences read_preferences(const std::filesystem::path& path);

/// Writes the preferences, completely or not at all; creates the folder. Throws Error.
void write_preferences(const Preferences& preferences, const std::filesystem::path& path);

/// Moves a path to the front of the recent files.
void remember(Preferences& preferences, const std::string& path);

/// Removes recent files that no longer exist.
void remove_missing(Preferences& preferences);

}  // namespace edgesplat::viewer
