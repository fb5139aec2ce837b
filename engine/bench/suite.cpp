#include "engine/bench/suite.h"

#include <fnmatch.h>

#include <algorithm>

#include "engine/bench/embedded_suites.h"
#include "engine/error.h"
#include "engine/scene/nearest_name.h"
#include "engine/scene/text_file.h"

namespace edgesplat::bench {
namespace {

namespace fs = std::filesystem;

bool like(const std::string& name, const std::string& glob) {
    return ::fnmatch(glob.c_str(), name.c_str(), 0) == 0;
}

}  // namespace

Suite read_suite(const std::string& name_or_path) {
    const fs::path path(name_or_path);
    if (path.extension() == ".toml")
        return parse_suite(read_text_file(path, "a suite of benchmarks"), name_or_path,
                           volume_folders(path.parent_path()));
    std::vector<std::string> names;
    for (const EmbeddedSuite& suite : embedded_suites()) {
        if (suite.name == name_or_path)
            return parse_suite(suite.text, fmt::format("{}.toml", suite.name), volume_folders({}));
        names.emplace_back(suite.name);
    }
    const std::string nearest = nearest_name(name_or_path, names);
    fail("unknown suite '{}'; expected {} or a file (.toml){}", name_or_path, fmt::join(names, ", "),
         nearest.empty() ? "" : "; did you mean " + nearest + "?");
}

void keep_cases(Suite& suite, const std::string& glob) {
    const auto group_of = [](const std::string& name) { return name.substr(0, name.find('/')); };
    std::vector<std::string> names;
    for (const SuiteCase& entry : suite.cases)
        names.push_back(entry.name);
    for (const SkippedCase& entry : suite.skipped)
        names.push_back(entry.name);
    const auto unwanted = [&](const auto& entry) {
        return !like(entry.name, glob) && !like(group_of(entry.name), glob);
    };
    std::erase_if(suite.cases, unwanted);
    std::erase_if(suite.skipped, unwanted);
    if (suite.cases.empty() && suite.skipped.empty())
        fail("no case matches '{}'; the cases are:\n{}", glob, fmt::join(names, "\n"));
}

}  // namespace edgesplat::bench
