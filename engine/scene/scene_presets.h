// Materials, transfer functions and looks that have a name: TOML files of a user's folders and of the program itself.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "engine/scene/scene_document.h"

namespace edgesplat {

enum class PresetKind {
    Material,  ///< one material, with an iso-value where it has one that fits everywhere
    Transfer,  ///< a transfer function, with the iso-values at which it has edges
    Look,      ///< all that is to be seen and in which light: any of what `use_look` takes
};

/// A part of a scene under a name.
struct ScenePreset {
    std::string name;
    std::string file;  ///< where it comes from; "built in" for those of the program
    PresetKind kind = PresetKind::Material;
    SceneDocument content;
    bool is_transfer() const { return kind == PresetKind::Transfer; }
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

/// What a scene looks like, by a preset of any kind: takes iso-values, materials, transfer function, ambient light,
/// lights, background and effects from it, and its labels. Throws Error as `scene_preset` does.
void use_look(SceneDocument& document, std::string_view name);

}  // namespace edgesplat
