// Suites of benchmarks: the scenes that are measured, with sizes and modes, as TOML (docs/benchmarks.md).
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "engine/scene/scene_document.h"

namespace edgesplat::bench {

/// One picture that is measured.
struct SuiteCase {
    std::string name;    ///< case/mode/WIDTHxHEIGHT
    std::string about;   ///< description
    std::string group;   ///< the case's own name
    std::string mode;    ///< one of the suite's modes
    std::string series;  ///< scaling cases: name of their series; empty: none
    std::string camera;  ///< far, near, grazing or inside, found from the data; empty: the document's camera
    SceneDocument document;
};

struct SkippedCase {
    std::string name, reason;
};

struct Suite {
    std::string name, about;
    std::string file;     ///< name in messages
    double budget = 240;  ///< seconds
    std::vector<SuiteCase> cases;
    std::vector<SkippedCase> skipped;  ///< cases whose volume is missing
    /// Volumes that need not be read: that of volume_suite.
    std::vector<std::pair<VolumeSource, std::shared_ptr<const Volume>>> loaded;
};

/// Reads a suite; `folders` are searched for its volumes. Throws SceneFileError with all problems: file, line, key,
/// value, expectation.
Suite parse_suite(std::string_view text, const std::string& file, const std::vector<std::filesystem::path>& folders);

/// A suite by its name (standard, scaling, full) or its file (.toml); the file's folder is searched for
/// volumes, too. nullopt for the path of a volume. Throws Error for any other text.
std::optional<Suite> find_suite(const std::string& name_or_path);

/// The suite of one volume: the cameras far, near and inside, edge-preserved (mode `default`) and plain, in about a
/// minute. `document` is a scene without a camera whose volume is `volume`. Throws Error.
Suite volume_suite(const SceneDocument& document, const std::shared_ptr<const Volume>& volume);

/// Keeps the cases whose name or group matches `glob` (with * and ?). Throws Error with all names if there are none.
void keep_cases(Suite& suite, const std::string& glob);

}  // namespace edgesplat::bench
