// Suites of benchmarks: which scenes are measured, at which sizes, in which modes. TOML, docs/benchmarks.md.
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
    std::string mode;    ///< of the suite's modes
    std::string series;  ///< scaling cases: what they are compared with; empty: none
    std::string camera;  ///< far, near, grazing or inside, found in the data; empty: that of the document
    SceneDocument document;
};

struct SkippedCase {
    std::string name, reason;
};

struct Suite {
    std::string name, about;
    std::string file;     ///< as messages call it
    double budget = 240;  ///< seconds
    std::vector<SuiteCase> cases;
    std::vector<SkippedCase> skipped;  ///< cases whose volume is not here
};

/// Reads a suite; its volumes are looked for in `folders`. Throws SceneFileError with every problem: file, line, key,
/// value, what was expected.
Suite parse_suite(std::string_view text, const std::string& file, const std::vector<std::filesystem::path>& folders);

/// A suite by its name (standard, scaling, full), or a file (.toml), whose folder is looked through for volumes, too.
/// Throws Error.
Suite read_suite(const std::string& name_or_path);

/// Keeps the cases whose name or group is like `glob` (with * and ?). Throws Error with the names where none is.
void keep_cases(Suite& suite, const std::string& glob);

}  // namespace edgesplat::bench
