// Reads scene files (TOML) into a SceneDocument and writes them. Every problem of a file is reported with its line.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "engine/error.h"
#include "engine/scene/scene_document.h"

namespace edgesplat {

/// All problems of a scene file, one per line: "cut.toml:14: effects.fog.densty: unknown key; ...".
class SceneFileError : public Error {
  public:
    explicit SceneFileError(std::vector<std::string> problems);
    const std::vector<std::string>& problems() const { return problems_; }

  private:
    std::vector<std::string> problems_;
};

/// Options of `parse_scene`.
struct SceneTextOptions {
    std::vector<std::filesystem::path> folders;  ///< folders in which its volume is searched
    bool whole = true;                           ///< also checks across keys: counts, order, existing files
    bool preset = false;  ///< the text is a preset: a part of a scene, without volume, camera or quality
};

/// Reads TOML text; messages use `name` as the file name. Throws SceneFileError.
SceneDocument parse_scene(std::string_view text, const std::string& name, const SceneTextOptions& options);

/// Reads a scene file. Its volume is searched in the file's folder, then in EDGESPLAT_VOLUMES. Throws SceneFileError.
SceneDocument read_scene_file(const std::filesystem::path& path);

/// Whether a path ends in .toml.
bool is_scene_path(const std::filesystem::path& path);

/// Sets one key from "key=value". The value is TOML; texts, names and lists of numbers may omit quotes and brackets:
/// "camera.view=back", "background=0,0,0.2". An index one past the end of a list appends an entry. An effect's keys
/// create its table; "effects.fog=true" creates and "effects.fog=false" removes it. Throws Error.
void set_key(SceneDocument& document, std::string_view assignment);

/// Throws Error if the volume's path is not UTF-8, so that a scene file cannot contain it.
void check_path_is_text(const SceneDocument& document);

/// The document as TOML: every key that has a value. Reading it gives an equal document; bytes that are not UTF-8
/// become U+FFFD.
std::string scene_text(const SceneDocument& document);

/// The document as TOML with comments: each key with its description; omitted keys are commented out with their
/// default.
std::string commented_scene_text(const SceneDocument& document);

/// The table of keys as plain text, and as Markdown for docs/scene_files.md.
std::string scene_keys_text();
std::string scene_keys_markdown();

}  // namespace edgesplat
