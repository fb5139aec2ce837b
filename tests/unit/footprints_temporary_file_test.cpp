// Temporary files: they replace their target completely or vanish; files of dead processes are removed.
#include "footprints/temporary_file.h"

#include <fcntl.h>
#include <gmock/gmock.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <fstream>
#include <iterator>
#include <optional>
#include <string>
#include <system_error>
#include <vector>

namespace edgesplat {
namespace {

namespace fs = std::filesystem;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

class TemporaryFiles : public testing::Test {
  protected:
    void SetUp() override { fs::create_directories(folder_); }
    void TearDown() override { fs::remove_all(folder_); }

    std::vector<std::string> files() const {
        std::vector<std::string> names;
        for (const auto& entry : fs::directory_iterator(folder_))
            names.push_back(entry.path().filename().string());
        std::ranges::sort(names);
        return names;
    }
    std::string text() const {
        std::ifstream file(target_, std::ios::binary);
        return {std::istreambuf_iterator<char>(file), {}};
    }
    /// Calls `body` in a child process; returns its wait status.
    template <typename Body>
    static int in_child(const Body& body) {
        const pid_t child = fork();
        if (child == 0) {
            body();
            _exit(0);
        }
        int status = 0;
        waitpid(child, &status, 0);
        return status;
    }

    fs::path folder_ =
        fs::path(testing::TempDir()) /
        (std::string(testing::UnitTest::GetInstance()->current_test_info()->name()) + "_" + std::to_string(getpid()));
    fs::path target_ = folder_ / "target.bin";
};

TEST_F(TemporaryFiles, ReplaceTheirTargetOrVanish) {
    std::ofstream(target_) << "old";
    {
        TemporaryFile file(target_);
        file.write("half");
        EXPECT_EQ(text(), "old");
        EXPECT_EQ(files().size(), 2U);
    }
    EXPECT_THAT(files(), ElementsAre("target.bin"));
    EXPECT_EQ(text(), "old");
    TemporaryFile file(target_);
    file.write("new");
    file.sync();
    file.rename_to_target();
    EXPECT_EQ(text(), "new");
    EXPECT_THAT(files(), ElementsAre("target.bin"));
}

TEST_F(TemporaryFiles, RemovesOnlyThoseOfDeadProcesses) {
    const int status = in_child([&] {
        TemporaryFile file(target_);
        file.write("half");
        raise(SIGKILL);
    });
    ASSERT_TRUE(WIFSIGNALED(status));
    ASSERT_EQ(files().size(), 1U);
    const TemporaryFile living(folder_ / "other.bin");
    EXPECT_THAT(files(), ElementsAre(living.path().filename().string()))
        << "the first file in a folder removes stale ones";
    in_child([&] { remove_stale_temporaries(folder_); });
    EXPECT_THAT(files(), ElementsAre(living.path().filename().string())) << "a locked file stays";
}

TEST_F(TemporaryFiles, KeepsThoseOfOtherPrograms) {
    const std::vector<std::string> foreign{".a.12-3.tmp",          ".a.edgesplat-.tmp", ".a.edgesplat-1-.tmp",
                                           ".a.edgesplat-x-1.tmp", ".a.edgesplat-1-1",  "a.edgesplat-1-1.tmp"};
    for (const std::string& name : foreign)
        std::ofstream(folder_ / name) << "theirs";
    fs::create_directory(folder_ / ".a.edgesplat-1-2.tmp");
    fs::create_symlink("a.edgesplat-1-1.tmp", folder_ / ".a.edgesplat-1-3.tmp");
    std::ofstream(folder_ / ".a.edgesplat-1-4.tmp") << "ours";
    remove_stale_temporaries(folder_);
    EXPECT_EQ(files().size(), foreign.size() + 2);
    EXPECT_FALSE(fs::exists(folder_ / ".a.edgesplat-1-4.tmp"));
    remove_stale_temporaries(folder_ / "missing");
}

TEST_F(TemporaryFiles, ReportsWhyCreationFails) {
    try {
        const TemporaryFile file(folder_ / "missing" / "target.bin");
        FAIL();
    } catch (const std::system_error& error) {
        EXPECT_EQ(error.code().value(), ENOENT);
    }
    EXPECT_THAT(files(), IsEmpty());
    const TemporaryFile longest(folder_ / std::string(255, 'x'));
    EXPECT_TRUE(fs::exists(longest.path()));
}

TEST_F(TemporaryFiles, DeferSignalsUntilWritten) {
    const int status = in_child([&] {
        std::optional<DeferSignals> outer(std::in_place), inner(std::in_place);
        raise(SIGTERM);
        outer.reset();
        std::ofstream(target_) << "written after the signal";
        inner.reset();
        _exit(1);
    });
    EXPECT_TRUE(WIFSIGNALED(status) && WTERMSIG(status) == SIGTERM);
    EXPECT_THAT(text(), HasSubstr("after the signal"));
}

}  // namespace
}  // namespace edgesplat
