// Ctrl-C at any time in any long command: it ends within two seconds, with the shell's status for it, and the output is
// either resumable or untouched.
#include "tests/stability/faults_program.h"

namespace edgesplat {
namespace {

using testing::IsEmpty;

using Clock = std::chrono::steady_clock;

/// A long command, and when to interrupt it.
struct LongRun {
    const char* name;
    const char* arguments;
    int milliseconds;        ///< after its start
    const char* left = "";   ///< prefix of the files that may exist afterwards
    const char* ready = "";  ///< wait for this file first
};

class FaultsStop : public FaultsTest, public testing::WithParamInterface<LongRun> {
  protected:
    /// Starts the command in a fresh folder and waits; nullopt if it has ended by then.
    std::optional<pid_t> running_after(std::chrono::milliseconds delay) const {
        std::filesystem::remove_all(folder_);
        std::filesystem::create_directories(folder_);
        std::ofstream(folder_ / "suite.toml") << "budget = 100\n[[cases]]\nname = \"ball\"\nsizes = [[900, 900]]\n"
                                                 "scene = { volume = { path = \"builtin:sphere:128\" } }\n";
        std::ofstream(folder_ / "old.png") << "old";
        std::ofstream(folder_ / "old.esv") << "old";
        const std::filesystem::path ready = folder_ / GetParam().ready;
        const pid_t child = start(GetParam().arguments);
        for (int i = 0; i < 3000 && !std::filesystem::exists(ready); ++i)
            std::this_thread::sleep_for(std::chrono::milliseconds(10));
        std::this_thread::sleep_for(delay);
        int status = 0;
        if (waitpid(child, &status, WNOHANG) == 0) return child;
        EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0) << status;
        return {};
    }
};

TEST_P(FaultsStop, EndsSoonWithoutPartialOutput) {
    const LongRun& long_run = GetParam();
    // Machines differ in speed: if the command ends before the signal, the signal comes earlier.
    std::optional<pid_t> begun;
    for (std::chrono::milliseconds delay(long_run.milliseconds); !begun; delay /= 2) {
        begun = running_after(delay);
        ASSERT_TRUE(begun || delay.count() > 0) << "the command always ended before the signal";
    }
    const pid_t child = *begun;
    const auto asked = Clock::now();
    kill(child, SIGINT);
    int status = 0;
    waitpid(child, &status, 0);
    // Two seconds on an otherwise idle machine; tests run in parallel.
    EXPECT_LT(std::chrono::duration<double>(Clock::now() - asked).count(), 3.0);
    // A shell reports 130 for both.
    EXPECT_TRUE((WIFEXITED(status) && WEXITSTATUS(status) == 130) ||
                (WIFSIGNALED(status) && WTERMSIG(status) == SIGINT))
        << status;
    EXPECT_THAT(temporaries(), IsEmpty());
    for (const auto& [file, bytes] : contents()) {
        if (file == "suite.toml") continue;
        if (file.starts_with("old."))
            EXPECT_EQ(bytes, "old") << file;
        else
            EXPECT_TRUE(*long_run.left != 0 && file.starts_with(long_run.left)) << file;
    }
}

INSTANTIATE_TEST_SUITE_P(
    Faults, FaultsStop,
    testing::Values(
        LongRun{"RenderBegins", "render builtin:sphere:200 --size 1500x1500 -o old.png", 20},
        LongRun{"Render", "render builtin:sphere:200 --size 1500x1500 -o old.png", 1500},
        LongRun{"RenderReference", "render builtin:sphere:64 --size 300x300 --renderer reference -o old.png", 700},
        LongRun{"RenderMaxError", "render builtin:sphere:128 --size 900x900 --max-error 1% -o old.png", 1200},
        LongRun{"MovieFrame", "movie builtin:sphere:160 --size 1500x1500 --orbit 90 -o frames/f_%04d.png", 2500,
                "frames/", "frames/movie.json"},
        LongRun{"MovieFilm", "movie builtin:torus:16 --size 24x24 --orbit 90 -o a.mp4", 300, "a.mp4.frames/",
                "a.mp4.frames/frame_00002.png"},
        LongRun{"MovieEncoder",
                "movie builtin:torus:16 --renderer raycast --size 1400x1400 --orbit 4 --seconds .2 -o a.mp4", 0,
                "a.mp4.frames/", "a.mp4.frames/unfinished.mp4"},
        LongRun{"Pack", "pack builtin:sphere:300 -o old.esv", 600},
        LongRun{"PackWrites", "pack builtin:sphere:300 --compress -o old.esv", 3500},
        LongRun{"Accuracy", "accuracy builtin:sphere:64 --report report", 3000, "report/", "report/journal.jsonl"},
        LongRun{"AccuracyLoads", "accuracy builtin:sphere:64 --report report", 10, "report/"},
        LongRun{"AccuracyCoarse", "accuracy builtin:sphere:128 --report report --downsample 2,4", 1500, "report/"},
        LongRun{"Bench", "bench suite.toml -o bench", 1500},
        LongRun{"Footprints", "footprints --report --samples 10000000", 1000}),
    [](const testing::TestParamInfo<LongRun>& parameter) { return std::string(parameter.param.name); });

using FaultsStopped = FaultsTest;

TEST_F(FaultsStopped, ComparisonOfLargePicturesEnds) {
    for (const char* name : {"a.exr", "b.exr"})
        ASSERT_EQ(run(std::string("render builtin:torus:16 --edges off --size 1500x1500 -o ") + name).status, 0);
    const pid_t child = start("compare a.exr b.exr --diff d.exr");
    std::this_thread::sleep_for(std::chrono::milliseconds(60));
    kill(child, SIGINT);
    int status = 0;
    waitpid(child, &status, 0);
    EXPECT_TRUE(WIFSIGNALED(status) || WEXITSTATUS(status) == 0 || WEXITSTATUS(status) == 1) << status;
    EXPECT_THAT(temporaries(), IsEmpty());
}

}  // namespace
}  // namespace edgesplat
