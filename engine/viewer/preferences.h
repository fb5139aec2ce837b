// What a user's window remembers from one start to the next.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace edgesplat::viewer {

struct Preferences {
    std::vector<std::string> recent;  ///< files that were opened, the last one first; at most kMostRecent
    int width = 1280, height = 800;   ///< of the window
    double target = 0;                ///< milliseconds a picture may take while something moves; 0: by the device
    double turn = 1, speed = 1;       ///< factors on how fast one turns and flies
    double text_scale = 0;            ///< of the window's text; 0: by the screen
    bool collisions = true;
    bool invert_look = false;
    std::string device;  ///< see DeviceChoice
    bool operator==(const Preferences&) const = default;
};

inline constexpr std::size_t kMostRecent = 12;

/// $XDG_CONFIG_HOME/edgesplat/fly.toml (~/.config/edgesplat/fly.toml); empty where neither is known.
std::filesystem::path preferences_path();

/// Reads them; what is missing or of no use there is as in `Preferences{}`, and a file that cannot be read is as none.
Preferences read_preferences(const std::filesystem::path& path);

/// Writes them, whole or not at all; makes the folder. Throws Error.
void write_preferences(const Preferences& preferences, const std::filesystem::path& path);

/// Puts a path in front of the recent ones.
void remember(Preferences& preferences, const std::string& path);

/// Takes those of the recent ones out that stand for nothing any more.
void forget_lost(Preferences& preferences);

}  // namespace edgesplat::viewer
