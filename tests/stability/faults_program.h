// The real program under faults: on a full disk, killed, interrupted, with a failing device.
#pragma once

#include <gmock/gmock.h>

#include <cstdlib>
#include <map>
#include <optional>

#include "tests/unit/cli_program.h"

namespace edgesplat {

/// Whether all moments are tested, not only a few.
inline bool full_faults() {
    const char* value = std::getenv("EDGESPLAT_FULL_FAULTS");
    return value != nullptr && std::string(value) == "1";
}

/// A fresh folder, and a cache for the suite that the first test fills.
class FaultsTest : public CliTest {
  protected:
    static constexpr const char* kPicture = "render builtin:torus:16 --size 24x24 ";

    static void SetUpTestSuite() {
        setenv("EDGESPLAT_CACHE", cache().c_str(), 1);  // NOLINT(concurrency-mt-unsafe): before any thread
    }
    static void TearDownTestSuite() { std::filesystem::remove_all(cache()); }

    static std::filesystem::path cache() {
        return std::filesystem::temp_directory_path() / ("edgesplat_faults_cache_" + std::to_string(getpid()));
    }

    /// All files below the folder with their bytes, by relative path.
    std::map<std::string, std::string> contents(const std::string& below = "") const {
        std::map<std::string, std::string> all;
        const auto root = folder_ / below;
        for (const auto& entry : std::filesystem::recursive_directory_iterator(root))
            if (entry.is_regular_file())
                all[std::filesystem::relative(entry.path(), root).string()] = text_of(entry.path());
        return all;
    }

    /// Files that only a running program may have, here or in the cache.
    std::vector<std::string> temporaries() const {
        std::vector<std::string> found;
        for (const auto& root : {folder_, cache()}) {
            if (!std::filesystem::exists(root)) continue;
            for (const auto& entry : std::filesystem::recursive_directory_iterator(root)) {
                const std::string name = entry.path().filename().string();
                if (name.starts_with('.') || name.ends_with(".tmp") || name.starts_with("unfinished"))
                    found.push_back(entry.path().string());
            }
        }
        return found;
    }

    /// Expects an exit status of 1 and an error message of one line.
    static void expect_one_message(const ProgramRun& run, const std::string& words) {
        EXPECT_EQ(run.status, 1) << run.err;
        EXPECT_THAT(run.err, testing::StartsWith("edgesplat: error: "));
        EXPECT_EQ(std::count(run.err.begin(), run.err.end(), '\n'), 1) << run.err;
        EXPECT_THAT(run.err, testing::HasSubstr(words));
    }

    /// Starts `edgesplat ARGUMENTS` inside the folder without output; returns its process.
    pid_t start(const std::string& arguments) const {
        const std::string command = "cd '" + folder_.string() + "' && exec '" EDGESPLAT_PROGRAM "' " + arguments +
                                    " >/dev/null 2>&1 </dev/null";
        std::string shell = "/bin/sh", flag = "-c", text = command;
        char* all[] = {shell.data(), flag.data(), text.data(), nullptr};
        pid_t child = 0;
        EXPECT_EQ(posix_spawn(&child, "/bin/sh", nullptr, nullptr, all, environ), 0);
        return child;
    }
};

}  // namespace edgesplat
