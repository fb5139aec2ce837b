// Named materials, transfer functions and looks: TOML files in users' folders and in the program.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "engine/scene/scene_document.h"

namespace edgesplat {

enum class PresetKind {
    Material,  ///< one material, with an iso-value if one value fits all volumes
    Transfer,  ///< a transfer function with the iso-values of its edges
    Look,      ///< a complete appearance: any of the values that `apply_look` applies
};

/// A named part of a scene.
struct ScenePreset {
    std::string name;
    std::string file;  ///< its file; "built in" for presets of the program
    PresetKind kind = PresetKind::Material;
    SceneDocument content;
    bool is_transfer() const { return kind == PresetKind::Transfer; }
};

/// $XDG_CONFIG_HOME/edgesplat (~/.config/edgesplat); empty if neither variable is set.
std::filesystem::path config_folder();

/// The folders of users' presets, highest priority first: those in EDGESPLAT_PRESETS (separated by colons), then
/// $XDG_CONFIG_HOME/edgesplat/presets (~/.config/edgesplat/presets).
std::vector<std::filesystem::path> preset_folders();

/// Names of all presets, sorted. If a name occurs several times, the first file in the order of folders is used; the
/// program's presets have the lowest priority.
std::vector<std::string> scene_preset_names();

/// The preset with this name. Throws Error if it does not exist (with the closest name) or its file is invalid.
ScenePreset scene_preset(std::string_view name);

/// Applies a preset of any kind: sets iso-values, materials, transfer function, ambient light, lights, background,
/// effects and `volume.labels`. Throws Error as `scene_preset` does.
void apply_look(SceneDocument& document, std::string_view name);

}  // namespace edgesplat
