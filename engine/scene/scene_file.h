// Scene files: TOML in, a SceneDocument out, and back. Every problem of a file is reported with its line.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "engine/error.h"
#include "engine/scene/scene_document.h"

namespace edgesplat {

/// Everything that is wrong with a scene file, one line each: "cut.toml:14: effects.fog.densty: unknown key; ...".
class SceneFileError : public Error {
  public:
    explicit SceneFileError(std::vector<std::string> problems);
    const std::vector<std::string>& problems() const { return problems_; }

  private:
    std::vector<std::string> problems_;
};

/// How a text is read.
struct SceneTextOptions {
    std::vector<std::filesystem::path> folders;  ///< where its volume is looked for
    bool whole = true;    ///< also what single keys cannot tell is checked: counts, order, files that are there
    bool preset = false;  ///< it is one: a part of a scene, without a volume, camera or quality
};

/// Reads TOML text; `name` is what messages call it. Throws SceneFileError.
SceneDocument parse_scene(std::string_view text, const std::string& name, const SceneTextOptions& options);

/// Reads a scene file; its volume is looked for beside it, then in EDGESPLAT_VOLUMES. Throws SceneFileError.
SceneDocument read_scene_file(const std::filesystem::path& path);

/// Whether a path names a scene file, by its ending .toml.
bool is_scene_path(const std::filesystem::path& path);

/// Sets one key from "key=value", the value as TOML or, for texts, names and lists of numbers, without quotes and
/// brackets: "camera.view=back", "background=0,0,0.2". An index one past the end of a list makes a new entry; an
/// effect's table is made by its keys, or by "effects.fog=true", and taken away by "effects.fog=false". Throws Error.
void set_key(SceneDocument& document, std::string_view assignment);

/// Throws Error where the volume's path is not UTF-8: a scene file could not name it.
void check_path_is_text(const SceneDocument& document);

/// The document as TOML: every key that has a value. Reading it back gives an equal document; bytes that are not UTF-8
/// become U+FFFD.
std::string scene_text(const SceneDocument& document);

/// The same for people: each key with what it means, those that are not given commented out with what holds then.
std::string commented_scene_text(const SceneDocument& document);

/// The table of keys for people: plain text, or Markdown as in docs/scene_files.md.
std::string scene_keys_text();
std::string scene_keys_markdown();

}  // namespace edgesplat
