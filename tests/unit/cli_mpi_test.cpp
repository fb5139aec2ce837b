// `mpirun edgesplat`: several processes render the picture of one; if one of them fails, no file is left.
#include <gmock/gmock.h>
#include <signal.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <fstream>
#include <nlohmann/json.hpp>
#include <thread>

#include "engine/image/image_compare.h"
#include "engine/image/image_file.h"
#include "tests/unit/cli_program.h"

namespace edgesplat {
namespace {

namespace fs = std::filesystem;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

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
    double psnr(const std::string& a, const std::string& b) const {
        const Image one = read_image(folder_ / a).image;
        const Image other = read_image(folder_ / b).image;
        return compare_images(one, other).psnr;
    }
    nlohmann::json statistics(const std::string& name) const { return nlohmann::json::parse(text_of(folder_ / name)); }
};

TEST_F(CliMpi, PicturesEqualThoseOfOneProcess) {
    for (const char* scene :
         {"builtin:cube-hole --direction 0.3,0.5,-1 --up 0,1,0", "builtin:orbital:32 --view oblique",
          "builtin:phantom:32 --sheets sliced --background 0.1,0.2,0.4 --samples 2"}) {
        SCOPED_TRACE(scene);
        const std::string request = std::string("render ") + scene + " --size 64x48 -o ";
        ASSERT_EQ(run(request + "1.exr").status, 0);
        for (const int ranks : {2, 4}) {
            const std::string name = std::to_string(ranks);
            std::string arguments = request;
            arguments.append(name).append(".exr --json ").append(name).append(".json");
            const ProgramRun made = good(ranks, arguments);
            EXPECT_THAT(made.out, HasSubstr("by " + name + " ranks: "));
            EXPECT_EQ(std::ranges::count(made.out, '\n'), 1) << made.out;
            const double likeness = psnr("1.exr", name + ".exr");
            std::printf("%d ranks, %s: %.1f dB\n", ranks, scene, likeness);
            EXPECT_GE(likeness, 90);
            const auto parts = statistics(name + ".json")["frames"][0]["ranks"];
            ASSERT_EQ(parts.size(), static_cast<std::size_t>(ranks));
            for (std::size_t i = 1; i < parts.size(); ++i)
                EXPECT_EQ(parts[i]["first_sheet"], parts[i - 1]["end_sheet"]);
            EXPECT_GT(parts[1]["draw_ms"], 0);
        }
    }
}

TEST_F(CliMpi, ExtraOutputsEqualThoseOfOneProcess) {
    const std::string request = "render builtin:orbital:24 --size 40x30 ";
    for (const char* more : {"--aov tau,depth,normal,distance", "--compare plain --overlay scale-bar,legend"}) {
        SCOPED_TRACE(more);
        ASSERT_EQ(run(request + more + " -o 1.exr").status, 0);
        good(3, request + more + " -o 3.exr");
        const LoadedImage one = read_image(folder_ / "1.exr"), three = read_image(folder_ / "3.exr");
        EXPECT_EQ(one.channel_names, three.channel_names);
        EXPECT_GE(compare_images(one.image, three.image).psnr, 80);
    }
}

/// A rod along z of varying thickness: samples of one byte, x fastest.
std::string rod(int width, int length) {
    std::string samples;
    for (int z = 0; z < length; ++z)
        for (int y = 0; y < width; ++y)
            for (int x = 0; x < width; ++x) {
                const double away = std::hypot(x - (width - 1) * .5, y - (width - 1) * .5);
                const double radius = width * (.3 + .1 * std::sin(z * .11));
                samples.push_back(static_cast<char>(std::clamp(128 + 20 * (radius - away), 0., 255.)));
            }
    return samples;
}

TEST_F(CliMpi, RanksHoldOnlyBlocksOfTheirSheets) {
    std::ofstream(folder_ / "rod.raw", std::ios::binary) << rod(28, 600);  // five blocks, one behind the other
    ASSERT_EQ(run("pack rod.raw --raw 28x28x600:uint8:little:1,1,1 -o vol.esv").status, 0);
    struct Case {
        const char* request;
        int ranks;
        bool divides;
    };
    for (const Case& test : {Case{"--direction 0.5,0.3,-1 --up 0,1,0", 4, true},
                             Case{"--direction 0.1,0.3,1 --up 0,1,0 --sheets sliced --sheet-spacing 1", 3, true},
                             Case{"--direction 0.5,0.3,-1 --up 0,1,0 --light 0,1,1 --shadows", 2, false}}) {
        SCOPED_TRACE(test.request);
        const std::string request = std::string("render vol.esv --iso 128 --size 64x48 ") + test.request + " -o ";
        const ProgramRun one = run(request + "1.exr --json 1.json");
        ASSERT_EQ(one.status, 0) << one.err;
        good(test.ranks, request + "n.exr --json n.json");
        const double likeness = psnr("1.exr", "n.exr");
        EXPECT_GE(likeness, 90);

        const auto all = statistics("1.json")["frames"][0]["splats_collected"].get<std::uint64_t>();
        std::printf("%d ranks: %.1f dB, splats", test.ranks, likeness);
        std::uint64_t most = 0, sum = 0;
        const auto parts = statistics("n.json")["frames"][0]["ranks"];
        for (const auto& part : parts) {
            const auto splats = part["splats"].get<std::uint64_t>();
            std::printf(" %llu", static_cast<unsigned long long>(splats));
            most = std::max(most, splats);
            sum += splats;
        }
        std::printf(" of %llu\n", static_cast<unsigned long long>(all));
        EXPECT_GE(sum, all);
        // A rank's first and last sheets lie in blocks that its neighbours hold, too.
        const std::uint64_t blocks = 5 / static_cast<std::uint64_t>(test.ranks) + 2;
        if (test.divides)
            EXPECT_LE(most, all * blocks / 5 + all / 20);
        else
            EXPECT_EQ(most, all);
    }
}

TEST_F(CliMpi, WorksWithMoreRanksThanSheets) {
    const std::string request = "render builtin:cube-hole --sheet-spacing 16 --size 32x32 -o ";
    ASSERT_EQ(run(request + "1.exr").status, 0);
    good(5, request + "5.exr --json 5.json");
    EXPECT_LT(statistics("5.json")["frames"][0]["sheets"], 5);
    EXPECT_GE(psnr("1.exr", "5.exr"), 90);
}

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
        mpirun_with(3, "set -- \"$@\" --memory-budget 1", "render builtin:orbital:48 --size 64x64 -o a.exr");
    EXPECT_EQ(failed.status, 1) << failed.err;
    EXPECT_THAT(failed.err, HasSubstr("rank 1 of 3: error: "));
    EXPECT_THAT(failed.err, HasSubstr("the memory budget"));
    EXPECT_THAT(files(), IsEmpty());
    // All ranks have the same invalid command line.
    const ProgramRun wrong = mpirun(3, "render builtin:orbital -o a.exr --size 0x4");
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
                                          "render builtin:phantom:96 --sheets sliced --size 1200x1200 -o a.exr");
    killer.join();
    EXPECT_NE(killed.status, 0);
    EXPECT_NE(killed.status, 124) << "it hung";
    EXPECT_THAT(killed.err, HasSubstr("signal 9"));
    EXPECT_THAT(files(), IsEmpty());
}

TEST_F(CliMpi, InterruptLeavesNoFile) {
    const ProgramRun stopped = run_shell("timeout --signal=INT --kill-after=" + std::string(kPatience) +
                                         " 1 mpirun -n 2 '" EDGESPLAT_PROGRAM
                                         "' render builtin:phantom:96 --sheets sliced --size 1200x1200 -o a.exr");
    EXPECT_NE(stopped.status, 0);
    EXPECT_NE(stopped.status, 137) << "it hung";
    EXPECT_THAT(files(), IsEmpty());
}

TEST_F(CliMpi, RefusesUndividedCommands) {
    const auto says = [&](const std::string& arguments, const char* what) {
        const ProgramRun result = mpirun(2, arguments);
        EXPECT_EQ(result.status, 1) << arguments;
        EXPECT_THAT(result.err, HasSubstr(what)) << arguments;
        EXPECT_THAT(files(), IsEmpty());
    };
    says("info builtin:torus", "info does not divide its work among ranks");
    says("render builtin:torus:20 -o a.exr --renderer raycast", "--renderer raycast does not draw sheets");
    says("render builtin:torus:20 -o a.exr --sheet-format layers", "--sheet-format tiles");
    EXPECT_THAT(good(2, "--version").out, HasSubstr("edgesplat"));
}

}  // namespace
}  // namespace edgesplat
