#include "engine/bench/suite.h"

#include <fnmatch.h>

#include <algorithm>

#include "engine/accuracy/report_cameras.h"
#include "engine/bench/embedded_suites.h"
#include "engine/error.h"
#include "engine/scene/nearest_name.h"
#include "engine/scene/text_file.h"

namespace edgesplat::bench {
namespace {

namespace fs = std::filesystem;

constexpr double kVolumeBudget = 50;  ///< seconds

bool like(const std::string& name, const std::string& glob) {
    return ::fnmatch(glob.c_str(), name.c_str(), 0) == 0;
}

}  // namespace

std::optional<Suite> find_suite(const std::string& name_or_path) {
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
    try {
        (void)find_volume(name_or_path, volume_folders({}));
        return {};
    } catch (const Error& error) {
        const std::string nearest = nearest_name(name_or_path, names);
        fail("'{}' is neither a suite ({} or a file .toml) nor a volume: {}", name_or_path, fmt::join(names, ", "),
             nearest.empty() ? error.what() : "did you mean " + nearest + "?");
    }
}

Suite volume_suite(const SceneDocument& document, const std::shared_ptr<const Volume>& volume) {
    const glm::ivec2 size = document.output.size;
    const glm::ivec3 dims = volume->geometry.dims;
    Suite suite{.name = document.volume.path, .file = document.volume.path, .budget = kVolumeBudget};
    suite.about = fmt::format("{}, {} x {} x {} voxels", document.volume.path, dims.x, dims.y, dims.z);
    const Scene scene = resolve_scene(document, *volume);
    Settings plain = document.quality.settings;
    plain.edges = EdgeEstimator::Off;
    for (const accuracy::ReportCamera& camera : accuracy::report_cameras(*volume, scene, size.x, size.y)) {
        if (camera.name == "grazing") continue;
        const auto add = [&](const char* mode, const Settings& settings) {
            suite.cases.push_back({.name = fmt::format("{}/{}/{}x{}", camera.name, mode, size.x, size.y),
                                   .about = camera.what,
                                   .group = camera.name,
                                   .mode = mode,
                                   .document = resolved(document, *volume, scene, camera.camera, settings)});
        };
        add("default", document.quality.settings);
        add("plain", plain);
    }
    suite.loaded.emplace_back(suite.cases.front().document.volume, volume);
    return suite;
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
