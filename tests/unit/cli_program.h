// Test fixture that runs the real program and keeps its output, for the cli_*_test.cpp files.
#pragma once

#include <gtest/gtest.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <thread>
#include <vector>

extern char** environ;  // NOLINT: the system's

namespace edgesplat {

/// Result of a run of the program.
struct ProgramRun {
    int status = -1;       ///< exit status; -1: it was killed
    std::string out, err;  ///< stdout and stderr
};

/// A fresh folder per test, in which `run` works.
class CliTest : public ::testing::Test {
  protected:
    void SetUp() override {
        // A killed process with the same id may have left its folder.
        std::filesystem::remove_all(folder_);
        std::filesystem::create_directories(folder_);
    }
    void TearDown() override {
        std::filesystem::remove_all(folder_);
        std::filesystem::remove_all(log_folder());
    }

    /// Runs `edgesplat ARGUMENTS` (as a shell reads them) inside the folder.
    ProgramRun run(const std::string& arguments) const { return run_shell("'" EDGESPLAT_PROGRAM "' " + arguments); }

    /// Runs any command inside the folder.
    ProgramRun run_shell(const std::string& line) const {
        std::filesystem::create_directories(log_folder());
        const std::string command = "cd '" + folder_.string() + "' && " + line + " >'" + log_folder().string() +
                                    "/out' 2>'" + log_folder().string() + "/err' </dev/null";
        const int status = std::system(command.c_str());  // NOLINT: a shell is wanted here
        return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, text_of(log_folder() / "out"),
                text_of(log_folder() / "err")};
    }

    /// Starts `edgesplat ARGUMENTS` in the same way and sends SIGINT once `ready()` is true, after 30 s at the latest.
    /// Returns the exit status as a shell reports it. It is also 130 if the signal ends the program, as it does without
    /// a progress bar.
    template <typename Ready>
    int interrupted(const std::string& arguments, const Ready& ready) const {
        const std::string command =
            "cd '" + folder_.string() + "' && exec '" EDGESPLAT_PROGRAM "' " + arguments + " 2>/dev/null";
        std::string shell = "/bin/sh", flag = "-c", text = command;
        char* all[] = {shell.data(), flag.data(), text.data(), nullptr};
        pid_t child = 0;
        EXPECT_EQ(posix_spawn(&child, "/bin/sh", nullptr, nullptr, all, environ), 0);
        for (int i = 0; i < 3000 && !ready(); ++i)
            std::this_thread::sleep_for(std::chrono::milliseconds(10));
        kill(child, SIGINT);
        int status = 0;
        waitpid(child, &status, 0);
        return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
    }

    /// Sorted names of all files in the folder, including hidden ones.
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
