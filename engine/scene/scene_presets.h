// Materials and transfer functions that have a name: TOML files of a user's folders and of the program itself.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "engine/scene/scene_document.h"

namespace edgesplat {

/// A part of a scene under a name: either one material, with an iso-value where it has one that fits everywhere, or a
/// transfer function, with the iso-values at which it has edges.
struct ScenePreset {
    std::string name;
    std::string file;       ///< where it comes from; "built in" for those of the program
    SceneDocument content;  ///< only `about`, `iso_values`, `materials` and `transfer` are used
    bool is_transfer() const { return !content.transfer.empty(); }
};

/// $XDG_CONFIG_HOME/edgesplat (~/.config/edgesplat); empty where neither is known.
std::filesystem::path config_folder();

/// Where users' presets are looked for, first come first: the folders in EDGESPLAT_PRESETS (colons between), then
/// $XDG_CONFIG_HOME/edgesplat/presets (~/.config/edgesplat/presets).
std::vector<std::filesystem::path> preset_folders();

/// Names of all presets, sorted. A name that occurs several times stands for the first file in the order above; the
/// program's own come last.
std::vector<std::string> scene_preset_names();

/// The preset of that name. Throws Error: no such preset (with the nearest name), or what is wrong with its file.
ScenePreset scene_preset(std::string_view name);

}  // namespace edgesplat
