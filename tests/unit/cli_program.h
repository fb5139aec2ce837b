// Runs the real program and keeps what it said, for the cli_*_test.cpp files.
#pragma once

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

namespace edgesplat {

/// What a run of the program left.
struct ProgramRun {
    int status = -1;       ///< exit status; -1: it was killed
    std::string out, err;  ///< stdout and stderr
};

/// A fresh folder per test, in which `run` works.
class CliTest : public ::testing::Test {
  protected:
    void SetUp() override { std::filesystem::create_directories(folder_); }
    void TearDown() override {
        std::filesystem::remove_all(folder_);
        std::filesystem::remove_all(log_folder());
    }

    /// Runs `edgesplat ARGUMENTS` (as a shell reads them) inside the folder.
    ProgramRun run(const std::string& arguments) const {
        std::filesystem::create_directories(log_folder());
        const std::string command = "cd '" + folder_.string() + "' && '" EDGESPLAT_PROGRAM "' " + arguments + " >'" +
                                    log_folder().string() + "/out' 2>'" + log_folder().string() + "/err' </dev/null";
        const int status = std::system(command.c_str());  // NOLINT: a shell is wanted here
        return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, text_of(log_folder() / "out"),
                text_of(log_folder() / "err")};
    }

    /// Names of what is in the folder, hidden files too, sorted.
    std::vector<std::string> files() const {
        std::vector<std::string> names;
        for (const auto& entry : std::filesystem::directory_iterator(folder_))
            names.push_back(entry.path().filename().string());
        std::sort(names.begin(), names.end());
        return names;
    }

    static std::string text_of(const std::filesystem::path& path) {
        std::ifstream file(path, std::ios::binary);
        return {std::istreambuf_iterator<char>(file), {}};
    }

    std::filesystem::path folder_ =
        std::filesystem::temp_directory_path() / ("edgesplat_cli_" + std::to_string(getpid()));

  private:
    std::filesystem::path log_folder() const { return folder_.string() + ".log"; }
};

}  // namespace edgesplat
