// Suites of benchmarks: the scenes that are measured, with sizes and modes, as TOML (docs/benchmarks.md).
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "engine/scene/scene_document.h"

namespace edgesplat::bench {

/// One picture that is measured.
struct SuiteCase {
    std::string name;    ///< case/mode/WIDTHxHEIGHT
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
};

/// Reads a suite; `folders` are searched for its volumes. Throws SceneFileError with all problems: file, line, key,
/// value, expectation.
Suite parse_suite(std::string_view text, const std::string& file, const std::vector<std::filesystem::path>& folders);

/// A suite by its name (standard, scaling, full) or its file (.toml); the file's folder is searched for
/// volumes, too. Throws Error.
Suite read_suite(const std::string& name_or_path);

/// Keeps the cases whose name or group matches `glob` (with * and ?). Throws Error with all names if there are none.
void keep_cases(Suite& suite, const std::string& glob);

}  // namespace edgesplat::bench
