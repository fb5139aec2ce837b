// Reads scene tables inside other TOML files: a table with the keys of a scene file.
#pragma once

#include <toml++/toml.h>

#include <functional>
#include <string>
#include <vector>

#include "engine/scene/scene_document.h"

namespace edgesplat {

/// A problem: its line in the file, and "key: value: what was expected".
struct SceneTableProblem {
    std::size_t line = 1;
    std::string text;
};

/// Reads the keys of a scene's table into `document`; `check` checks the result. Empty: no problems.
std::vector<SceneTableProblem> read_scene_table(
    SceneDocument& document, const toml::table& table,
    const std::function<std::vector<DocumentProblem>(const SceneDocument&)>& check = {});

/// Reads the node at one key, such as "quality".
std::vector<SceneTableProblem> read_scene_node(SceneDocument& document, const toml::node& node, const std::string& path,
                                               std::size_t line);

}  // namespace edgesplat
