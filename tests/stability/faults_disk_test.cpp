// A full disk: one message, the old file unchanged, no partial output. The disk is a small tmpfs in the test's own
// mount namespace.
#include "tests/stability/faults_program.h"

namespace edgesplat {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;

/// A command that writes below disk/, and the files that existed before.
struct Writer {
    const char* name;
    const char* arguments;
    std::vector<const char*> old;  ///< files that must survive
    std::vector<int> pages;        ///< free pages of 4 KiB
    const char* words = "No space left on device";
};

std::string unshare() {
    return std::string("unshare ") + (geteuid() == 0 ? "-m" : "-Urm");
}

class FaultsDisk : public FaultsTest {
  protected:
    void SetUp() override {
        FaultsTest::SetUp();
        const ProgramRun tried = run_shell(unshare() + " mount -t tmpfs none /tmp");
        if (tried.status != 0) GTEST_SKIP() << "this test may not mount a file system: " << tried.err;
    }

    /// Runs the program with a disk of `pages` free pages, and copies the disk's files to after/.
    ProgramRun run_on_full_disk(const std::string& arguments, const std::vector<const char*>& old, int pages,
                                const std::string& before = "") {
        std::filesystem::remove_all(folder_);
        std::filesystem::create_directories(folder_ / "disk");
        std::filesystem::create_directories(folder_ / "after");
        std::ofstream suite(folder_ / "suite.toml");
        suite << "[[cases]]\nname = \"ball\"\nsizes = [[24, 24]]\n"
                 "scene = { volume = { path = \"builtin:sphere:16\" } }\n";
        suite.close();
        std::ofstream script(folder_ / "script");
        script << "mount -t tmpfs -o size=256k none disk && mkdir disk/folder || exit 99\n";
        for (const char* file : old)
            script << "printf 'old %s' " << file << " >disk/" << file << "\n";
        script << before << "cat /dev/zero >disk/filler 2>/dev/null\ntruncate -s -" << pages * 4096
               << " disk/filler\n'" EDGESPLAT_PROGRAM "' " << arguments
               << "\nstatus=$?\nrm disk/filler\ncp -a disk/. after/\nexit $status\n";
        script.close();
        return run_shell(unshare() + " sh script");
    }

    void expect_old(const std::vector<const char*>& old) const {
        for (const char* file : old)
            EXPECT_EQ(text_of(folder_ / "after" / file), std::string("old ") + file);
    }
};

class FaultsDiskWriter : public FaultsDisk, public testing::WithParamInterface<Writer> {};

TEST_P(FaultsDiskWriter, KeepsExistingFiles) {
    const Writer& writer = GetParam();
    for (const int pages : writer.pages) {
        SCOPED_TRACE(std::to_string(pages) + " pages free");
        const ProgramRun result = run_on_full_disk(writer.arguments, writer.old, pages);
        expect_one_message(result, writer.words);
        expect_old(writer.old);
        EXPECT_THAT(temporaries(), IsEmpty());
    }
}

constexpr const char* kReport =
    "accuracy builtin:sphere:16 --report disk/folder --size 16x16 --repeats 1 --orbit 0 --knobs edges --cameras far -q";

INSTANTIATE_TEST_SUITE_P(
    Faults, FaultsDiskWriter,
    testing::Values(
        Writer{"Png", "render builtin:torus:16 --size 24x24 -o disk/a.png", {"a.png"}, {0}},
        Writer{"Exr", "render builtin:torus:16 --size 64x64 -o disk/a.exr", {"a.exr"}, {0, 1}},
        Writer{"SeveralOutputs",
               "render builtin:torus:16 --size 24x24 -o disk/a.png --aov tau,depth --json disk/a.json",
               {"a.png", "a.tau.exr", "a.depth.exr", "a.json"},
               {0, 2}},
        Writer{"Frames",
               "movie builtin:torus:16 --size 24x24 --orbit 20 --seconds .2 -o disk/folder/f_%02d.png",
               {},
               {0, 1, 2}},
        Writer{
            "Film", "movie builtin:torus:16 --size 24x24 --orbit 20 --seconds .2 -o disk/a.mp4", {"a.mp4"}, {1, 2, 6}},
        Writer{"Pack", "pack builtin:torus:48 -o disk/a.esv", {"a.esv"}, {0, 4}, "MB are free"},
        // Ranges, histogram, samples or attributes need the last page, one after the other.
        Writer{"PackCompressed", "pack builtin:torus:48 --compress -o disk/a.esv", {"a.esv"}, {0, 1, 2, 4, 16, 24}},
        Writer{"SceneFile", "scene new builtin:torus:16 -o disk/a.toml", {"a.toml"}, {0, 1}},
        Writer{"Info", "info builtin:torus:16 --json disk/a.json", {"a.json"}, {0}},
        Writer{"Footprints", "footprints --plot disk/folder", {}, {1}}, Writer{"Journal", kReport, {}, {0}},
        Writer{"References", kReport, {}, {3}},
        Writer{"Bench", "bench suite.toml --repeat 1 -q -o disk/folder", {"folder/bench.json"}, {0, 1}}),
    [](const testing::TestParamInfo<Writer>& parameter) { return std::string(parameter.param.name); });

TEST_F(FaultsDisk, MovieResumesOnceThereIsRoom) {
    const std::string movie = "movie builtin:torus:16 --size 24x24 --orbit 20 --seconds .2 -o ";
    ASSERT_EQ(run_on_full_disk(movie + "disk/folder/f_%02d.png", {}, 3).status, 1);
    const std::size_t there = contents("after/folder").size();
    EXPECT_GT(there, 1U);
    const ProgramRun rest = run(movie + "after/folder/f_%02d.png");
    EXPECT_EQ(rest.status, 0) << rest.err;
    EXPECT_THAT(rest.out, HasSubstr(std::to_string(there - 1) + " of 5 frames exist already"));
    ASSERT_EQ(run(movie + "whole/f_%02d.png").status, 0);
    EXPECT_EQ(contents("after/folder"), contents("whole"));
}

TEST_F(FaultsDisk, ReportResumesOnceThereIsRoom) {
    ASSERT_EQ(run_on_full_disk(kReport, {}, 8).status, 1);
    const auto journal = contents("after/folder")["journal.jsonl"];
    EXPECT_GT(journal.size(), 1000U);
    std::string again = kReport;
    again.replace(again.find("disk"), 4, "after");
    const ProgramRun rest = run(again);
    EXPECT_EQ(rest.status, 0) << rest.err;
    // No measurement was lost or repeated.
    EXPECT_EQ(contents("after/folder")["journal.jsonl"].substr(0, journal.rfind('\n') + 1),
              journal.substr(0, journal.rfind('\n') + 1));
}

TEST_F(FaultsDisk, FullCacheIsNoError) {
    ASSERT_EQ(run(std::string(kPicture) + "--footprints table -o a.png").status, 0);
    const std::string whole = text_of(folder_ / "a.png");
    for (const int pages : {0, 1}) {
        const std::string old = cache().string();
        setenv("EDGESPLAT_CACHE", "disk/folder", 1);  // NOLINT(concurrency-mt-unsafe)
        const ProgramRun result = run_on_full_disk(std::string(kPicture) + "--footprints table -o a.png", {}, pages);
        setenv("EDGESPLAT_CACHE", old.c_str(), 1);  // NOLINT(concurrency-mt-unsafe)
        EXPECT_EQ(result.status, 0) << result.err;
        EXPECT_THAT(result.err, IsEmpty());
        EXPECT_EQ(text_of(folder_ / "a.png"), whole);
        EXPECT_THAT(temporaries(), IsEmpty());
    }
}

}  // namespace
}  // namespace edgesplat
