// Scenes within other TOML files: a table of the keys of a scene file, read onto a document.
#pragma once

#include <toml++/toml.h>

#include <functional>
#include <string>
#include <vector>

#include "engine/scene/scene_document.h"

namespace edgesplat {

/// One thing that is wrong: the line in the file that the table came from, and "key: value: what was expected".
struct SceneTableProblem {
    std::size_t line = 1;
    std::string text;
};

/// Reads the keys of a scene's table onto `document`; `check` looks at the result. Empty: nothing is wrong.
std::vector<SceneTableProblem> read_scene_table(
    SceneDocument& document, const toml::table& table,
    const std::function<std::vector<DocumentProblem>(const SceneDocument&)>& check = {});

/// The same for what stands at one key, such as "quality".
std::vector<SceneTableProblem> read_scene_node(SceneDocument& document, const toml::node& node, const std::string& path,
                                               std::size_t line);

}  // namespace edgesplat
