// `mpirun edgesplat`: several processes draw the frames of one movie; if one of them fails, there is no film.
#include <gmock/gmock.h>
#include <signal.h>

#include <chrono>
#include <cstdlib>
#include <thread>

#include "tests/unit/cli_program.h"

namespace edgesplat {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;
using testing::IsEmpty;

/// Time limit of a job, seconds: it must end soon after one of its ranks ends.
constexpr const char* kPatience = "60";

class CliMpi : public CliTest {
  protected:
    void SetUp() override {
        CliTest::SetUp();
        if (std::system("command -v mpirun >/dev/null 2>&1") != 0)  // NOLINT: a shell is wanted here
            GTEST_SKIP() << "mpirun is not installed (Debian: openmpi-bin)";
        setenv("OMPI_ALLOW_RUN_AS_ROOT", "1", 1);
        setenv("OMPI_ALLOW_RUN_AS_ROOT_CONFIRM", "1", 1);
        setenv("OMPI_MCA_rmaps_base_oversubscribe", "1", 1);
        setenv("OMPI_MCA_hwloc_base_binding_policy", "none", 1);
        // The same for Open MPI 5.
        setenv("PRTE_MCA_rmaps_default_mapping_policy", ":oversubscribe", 1);
        setenv("PRTE_MCA_hwloc_default_binding_policy", "none", 1);
        if (run_shell("mpirun -n 1 '" EDGESPLAT_PROGRAM "' --list-devices").out.find("no Vulkan") == 0)
            GTEST_SKIP() << "no Vulkan device";
        const ProgramRun two = mpirun(2, "--version");
        if (two.err.find("built without MPI") != std::string::npos) GTEST_SKIP() << two.err;
    }
    ProgramRun mpirun(int ranks, const std::string& arguments) const {
        return run_shell("timeout " + std::string(kPatience) + " mpirun -n " + std::to_string(ranks) +
                         " '" EDGESPLAT_PROGRAM "' " + arguments);
    }
    /// Rank 1 runs the shell command `different` first, with its arguments in $@; the other ranks start as usual. All
    /// ranks get one command: Open MPI 5's mpirun crashes on a list of commands.
    ProgramRun mpirun_with(int ranks, const std::string& different, const std::string& arguments) const {
        return run_shell("timeout " + std::string(kPatience) + " mpirun -n " + std::to_string(ranks) +
                         " sh -c 'if [ $OMPI_COMM_WORLD_RANK = 1 ]; then " + different +
                         "; fi; exec \"$@\"' sh '" EDGESPLAT_PROGRAM "' " + arguments);
    }
    ProgramRun good(int ranks, const std::string& arguments) const {
        ProgramRun result = mpirun(ranks, arguments);
        EXPECT_EQ(result.status, 0) << arguments << '\n' << result.err;
        return result;
    }
};

TEST_F(CliMpi, MoviesHaveTheSameFrames) {
    const std::string movie = "movie builtin:torus:20 --orbit 90 --seconds 0.28 --size 32x24 ";  // 7 frames
    ASSERT_EQ(run(movie + "-o one/%d.png").status, 0);
    EXPECT_THAT(good(2, movie + "-o two/%d.png").out, HasSubstr("7 frames"));
    for (int i = 0; i < 7; ++i) {
        const std::string name = std::to_string(i) + ".png";
        EXPECT_EQ(text_of(folder_ / "one" / name), text_of(folder_ / "two" / name)) << name;
        EXPECT_GT(text_of(folder_ / "two" / name).size(), 100U);
    }
    // Existing frames are not rendered again.
    fs::remove(folder_ / "two/3.png");
    EXPECT_THAT(good(3, movie + "-o two/%d.png").out, HasSubstr("6 of 7 frames exist already"));
    EXPECT_EQ(text_of(folder_ / "one/3.png"), text_of(folder_ / "two/3.png"));
    if (run("movie builtin:torus:20 --orbit 9 --seconds 0.04 --size 32x24 -o film.mp4").status != 0) return;
    good(2, movie + "-o film.mp4");
    EXPECT_GT(fs::file_size(folder_ / "film.mp4"), 1000U);
    EXPECT_FALSE(fs::exists(folder_ / "film.mp4.frames"));
}

TEST_F(CliMpi, FailedRankEndsJob) {
    const ProgramRun failed =
        mpirun_with(3, "export EDGESPLAT_DEVICE_PROFILE=none", "movie builtin:torus:20 --orbit 9 -o a.mp4");
    EXPECT_EQ(failed.status, 1) << failed.err;
    EXPECT_THAT(failed.err, HasSubstr("rank 1 of 3: error: "));
    EXPECT_THAT(failed.err, HasSubstr("device profile `none`"));
    EXPECT_FALSE(fs::exists(folder_ / "a.mp4"));
    // All ranks have the same invalid command line.
    const ProgramRun wrong = mpirun(3, "movie builtin:orbital -o a.mp4 --size 0x4");
    EXPECT_EQ(wrong.status, 2) << wrong.err;
    EXPECT_THAT(wrong.err, HasSubstr("--size"));
}

TEST_F(CliMpi, KilledRankEndsJob) {
    std::thread killer([this] {
        const fs::path note = folder_.string() + ".log/pid";
        for (int i = 0; i < 6000 && text_of(note).find('\n') == std::string::npos; ++i)
            std::this_thread::sleep_for(std::chrono::milliseconds(5));
        std::this_thread::sleep_for(std::chrono::milliseconds(500));
        const int pid = std::atoi(text_of(note).c_str());  // NOLINT(cert-err34-c): written above
        if (pid > 0) kill(pid, SIGKILL);
    });
    const ProgramRun killed = mpirun_with(2, "echo $$ >\"" + folder_.string() + ".log/pid\"",
                                          "movie builtin:phantom:96 --orbit 360 --size 1200x1200 -o a.mp4");
    killer.join();
    EXPECT_NE(killed.status, 0);
    EXPECT_NE(killed.status, 124) << "it hung";
    EXPECT_THAT(killed.err, HasSubstr("signal 9"));
    EXPECT_FALSE(fs::exists(folder_ / "a.mp4"));
}

TEST_F(CliMpi, InterruptLeavesNoMovie) {
    const ProgramRun stopped = run_shell("timeout --signal=INT --kill-after=" + std::string(kPatience) +
                                         " 1 mpirun -n 2 '" EDGESPLAT_PROGRAM
                                         "' movie builtin:phantom:96 --orbit 360 --size 1200x1200 -o a.mp4");
    EXPECT_NE(stopped.status, 0);
    EXPECT_NE(stopped.status, 137) << "it hung";
    EXPECT_FALSE(fs::exists(folder_ / "a.mp4"));
}

TEST_F(CliMpi, RefusesUndividedCommands) {
    for (const std::string arguments : {"info builtin:torus", "render builtin:torus:20 -o a.exr"}) {
        const ProgramRun result = mpirun(2, arguments);
        EXPECT_EQ(result.status, 1) << arguments;
        EXPECT_THAT(result.err, HasSubstr("does not divide its work among ranks")) << arguments;
        EXPECT_THAT(files(), IsEmpty());
    }
    EXPECT_THAT(good(2, "--version").out, HasSubstr("edgesplat"));
}

}  // namespace
}  // namespace edgesplat
