// The presets embedded in the program: presets/*.toml (cmake/EmbedToml.cmake).
#pragma once

#include <span>
#include <string_view>

namespace edgesplat {

struct EmbeddedPreset {
    std::string_view name, text;  ///< file name without its ending; the file's TOML
};

std::span<const EmbeddedPreset> embedded_presets();

}  // namespace edgesplat
