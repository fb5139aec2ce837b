// Scene files as texts, read without a file.
#pragma once

#include <string>
#include <vector>

#include "engine/scene/scene_file.h"

namespace edgesplat {

inline SceneDocument parse(const std::string& text) {
    return parse_scene(text, "a.toml", {});
}

/// The lines of the SceneFileError that the text causes; empty if it is valid.
inline std::vector<std::string> problems(const std::string& text) {
    try {
        parse(text);
    } catch (const SceneFileError& error) {
        return error.problems();
    }
    return {};
}

}  // namespace edgesplat
