// kill -9 at random moments with a fixed seed, over a whole run. Afterwards each output is the old file or the new one.
// The next start of the same command writes what the first would have written, and nothing else.
// EDGESPLAT_FULL_FAULTS=1 tests all 200 moments.
#include <random>

#include "tests/stability/faults_program.h"

namespace edgesplat {
namespace {

using testing::IsEmpty;

using Clock = std::chrono::steady_clock;

/// A command that writes. `outputs`: files, or a folder with a slash at its end that is only complete at the end of the
/// run.
struct Writing {
    const char* name;
    const char* arguments;
    std::vector<const char*> outputs;
    int moments, all_moments;
};

class FaultsKill : public FaultsTest, public testing::WithParamInterface<Writing> {
  protected:
    static double seconds_since(Clock::time_point begin) {
        return std::chrono::duration<double>(Clock::now() - begin).count();
    }

    /// The bytes of a file without the time of its creation, which EXR files contain.
    std::string timeless(const char* file) const {
        std::string text = text_of(folder_ / file);
        const std::size_t at = text.find("capDate");
        if (at != std::string::npos && at < 200) text.replace(at + 19, 19, 19, '0');
        return text;
    }

    /// The existing outputs.
    std::map<std::string, std::string> outputs() const {
        std::map<std::string, std::string> all;
        for (const char* output : GetParam().outputs)
            if (std::filesystem::exists(folder_ / output)) all[output] = timeless(output);
        return all;
    }

    /// Runs the command and kills it after `seconds`, if it still runs. Returns whether it was killed.
    bool killed_after(double seconds) const {
        const pid_t child = start(GetParam().arguments);
        std::this_thread::sleep_for(std::chrono::duration<double>(seconds));
        kill(child, SIGKILL);
        int status = 0;
        waitpid(child, &status, 0);
        EXPECT_TRUE(WIFSIGNALED(status) || WEXITSTATUS(status) == 0) << status;
        return WIFSIGNALED(status);
    }
};

TEST_P(FaultsKill, LosesNothingAtAnyMoment) {
    const Writing& writing = GetParam();
    ASSERT_EQ(run(writing.arguments).status, 0);
    const auto fresh = outputs();
    const auto begin = Clock::now();
    ASSERT_EQ(run(writing.arguments).status, 0);
    const double lasts = seconds_since(begin);
    ASSERT_TRUE(outputs() == fresh) << "this test needs outputs that do not change from run to run";
    std::vector<std::string> names = files();

    std::mt19937 random(20);  // NOLINT(cert-msc32-c,cert-msc51-cpp): the same moments each time
    std::uniform_real_distribution<double> within(0, 1);
    const int moments = full_faults() ? writing.all_moments : writing.moments;
    int killed = 0;
    for (int i = 0; i < moments; ++i) {
        SCOPED_TRACE(i);
        for (const char* output : writing.outputs)
            std::ofstream(folder_ / output, std::ios::trunc) << "old " << output;
        // One moment in each of `moments` equal spans, so that even few moments include early and late ones.
        killed += killed_after((i + within(random)) / moments * 1.1 * lasts) ? 1 : 0;
        for (const char* output : writing.outputs) {
            const std::string there = timeless(output);
            EXPECT_TRUE(there == std::string("old ") + output || there == fresh.at(output))
                << output << " is neither the old file nor the new one: " << there.size() << " bytes";
        }
        const ProgramRun next = run(writing.arguments);
        EXPECT_EQ(next.status, 0) << next.err;
        EXPECT_TRUE(outputs() == fresh);
        EXPECT_EQ(files(), names);
        EXPECT_THAT(temporaries(), IsEmpty());
    }
    EXPECT_GT(killed, 0);
    RecordProperty("killed", killed);
}

constexpr const char* kKilledReport =
    "accuracy builtin:sphere:16 --report report --size 16x16 --repeats 1 --orbit 0 --knobs edges --cameras far -q";

INSTANTIATE_TEST_SUITE_P(
    Faults, FaultsKill,
    testing::Values(
        Writing{"Render", "render builtin:torus:16 --size 24x24 -o a.png", {"a.png"}, 6, 50},
        Writing{"SeveralOutputs",
                "render builtin:torus:16 --size 24x24 -o a.png --aov tau,depth",
                {"a.png", "a.tau.exr", "a.depth.exr"},
                3,
                30},
        Writing{"Movie", "movie builtin:torus:16 --size 24x24 --orbit 20 --seconds .2 -o a.mp4", {"a.mp4"}, 5, 40},
        Writing{"Pack", "pack builtin:torus:64 --compress -o a.esv", {"a.esv"}, 5, 35},
        Writing{"SceneFile", "scene new builtin:torus:16 -o a.toml", {"a.toml"}, 12, 25}),
    [](const testing::TestParamInfo<Writing>& parameter) { return std::string(parameter.param.name); });

/// A report has many files, and some contain times: only the measurements and the presence of files are compared.
TEST_F(FaultsTest, KilledReportsResume) {
    std::mt19937 random(21);  // NOLINT(cert-msc32-c,cert-msc51-cpp)
    std::uniform_real_distribution<double> share(0, 8);
    std::string journal;
    for (int i = 0; i < (full_faults() ? 20 : 2); ++i) {
        SCOPED_TRACE(i);
        const pid_t child = start(kKilledReport);
        std::this_thread::sleep_for(std::chrono::duration<double>(share(random)));
        kill(child, SIGKILL);
        waitpid(child, nullptr, 0);
        // Complete lines stay unchanged.
        std::string now = text_of(folder_ / "report/journal.jsonl");
        now.resize(now.rfind('\n') == std::string::npos ? 0 : now.rfind('\n') + 1);
        EXPECT_TRUE(now.starts_with(journal)) << "measurements were lost";
        journal = now;
        if (std::filesystem::exists(folder_ / "report/report.json")) {
            EXPECT_EQ(text_of(folder_ / "report/report.json").back(), '\n');
            std::filesystem::remove_all(folder_ / "report");
            journal.clear();
        }
    }
    const ProgramRun last = run(kKilledReport);
    EXPECT_EQ(last.status, 0) << last.err;
    EXPECT_TRUE(text_of(folder_ / "report/journal.jsonl").starts_with(journal));
    EXPECT_THAT(temporaries(), IsEmpty());
    for (const char* file : {"report.json", "steps.csv", "index.html"})
        EXPECT_TRUE(std::filesystem::exists(folder_ / "report" / file)) << file;
}

}  // namespace
}  // namespace edgesplat
