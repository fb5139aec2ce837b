// The cache folder of pipelines in every state: read-only, missing, a file, damaged, used by several processes. The
// picture is the same, and no message is printed.
#include <sys/stat.h>

#include "tests/stability/faults_program.h"

namespace edgesplat {
namespace {

namespace fs = std::filesystem;
using testing::IsEmpty;

constexpr const char* kRender = "render builtin:torus:16 --size 24x24 --footprints table -q -o a.png";

class FaultsCache : public FaultsTest {
  protected:
    void SetUp() override {
        FaultsTest::SetUp();
        ASSERT_EQ(run(kRender).status, 0);
        picture_ = text_of(folder_ / "a.png");
        fs::remove(folder_ / "a.png");
    }

    /// The same command with another cache folder, inside the test's own folder.
    ProgramRun run_with(const std::string& folder, const std::string& before = "") {
        fs::remove(folder_ / "a.png");
        const ProgramRun result =
            run_shell(before + "EDGESPLAT_CACHE='" + folder + "' '" EDGESPLAT_PROGRAM "' " + kRender);
        EXPECT_EQ(result.status, 0) << result.err;
        EXPECT_TRUE(text_of(folder_ / "a.png") == picture_);
        return result;
    }

    /// The files of a cache, sorted.
    std::vector<fs::path> files_of(const std::string& folder) const {
        std::vector<fs::path> all;
        for (const auto& entry : fs::directory_iterator(folder_ / folder))
            all.push_back(entry.path());
        std::sort(all.begin(), all.end());
        return all;
    }

    std::string picture_;
};

TEST_F(FaultsCache, IsCreatedIfMissing) {
    EXPECT_THAT(run_with("deep/down/cache").err, IsEmpty());
    EXPECT_EQ(files_of("deep/down/cache").size(), 1U);
}

TEST_F(FaultsCache, MayBeAFile) {
    std::ofstream(folder_ / "cache") << "a file";
    EXPECT_THAT(run_with("cache").err, IsEmpty());
    EXPECT_EQ(text_of(folder_ / "cache"), "a file");
}

TEST_F(FaultsCache, MayBeReadOnly) {
    // Root may write everywhere, except on a read-only file system.
    const bool root = geteuid() == 0;
    fs::create_directory(folder_ / "cache");
    if (!root) chmod((folder_ / "cache").c_str(), 0500);
    if (root && run_shell("unshare -m mount -t tmpfs -o ro none cache").status != 0)
        GTEST_SKIP() << "this test may not mount a file system";
    const ProgramRun result =
        root ? run_shell(
                   "unshare -m sh -c \"mount -t tmpfs -o ro none cache && EDGESPLAT_CACHE=cache '" EDGESPLAT_PROGRAM
                   "' " +
                   std::string(kRender) + "\"")
             : run_with("cache");
    EXPECT_EQ(result.status, 0);
    EXPECT_THAT(result.err, IsEmpty());
    EXPECT_TRUE(text_of(folder_ / "a.png") == picture_);
}

TEST_F(FaultsCache, MayBeUnset) {
    EXPECT_THAT(run_with("", "env -u HOME -u XDG_CACHE_HOME ").err, IsEmpty());
}

TEST_F(FaultsCache, IsRebuiltIfDamaged) {
    run_with("cache");
    const auto files = files_of("cache");
    ASSERT_EQ(files.size(), 1U);
    for (const fs::path& file : files) {
        SCOPED_TRACE(file.filename());
        const std::string whole = text_of(file);
        std::map<std::string, std::string> damages{{"empty", ""},
                                                   {"cut in the header", whole.substr(0, 11)},
                                                   {"cut at the end", whole.substr(0, whole.size() - 1)},
                                                   {"longer", whole + "x"},
                                                   {"another program's", "GIF89a" + whole.substr(6)},
                                                   {"of zeros", std::string(whole.size(), '\0')}};
        damages["of another version"] = whole;
        damages["of another version"][8] ^= 1;
        damages["a bit flipped"] = whole;
        damages["a bit flipped"][whole.size() / 2] ^= 16;
        damages["the last bit flipped"] = whole;
        damages["the last bit flipped"].back() ^= 1;
        for (const auto& [what, bytes] : damages) {
            SCOPED_TRACE(what);
            if (!full_faults() && (what == "longer" || what == "of zeros" || what.ends_with("program's") ||
                                   what == "cut in the header" || what == "the last bit flipped"))
                continue;
            std::ofstream(file, std::ios::binary | std::ios::trunc) << bytes;
            const ProgramRun result = run_with("cache");
            EXPECT_THAT(result.err, IsEmpty());
            EXPECT_TRUE(text_of(file) == whole);
            EXPECT_EQ(files_of("cache"), files);
        }
    }
    fs::remove(files[0]);
    fs::create_directory(files[0]);
    EXPECT_THAT(run_with("cache").err, IsEmpty());
}

TEST_F(FaultsCache, MayBeFilledByEightProcesses) {
    run_with("alone");
    std::string together;
    for (int i = 0; i < 8; ++i) {
        const std::string folder = "p" + std::to_string(i);
        fs::create_directory(folder_ / folder);
        together += "(cd " + folder + " && EDGESPLAT_CACHE=../cache '" EDGESPLAT_PROGRAM "' " + kRender +
                    " 2>err; echo $? >status) & ";
    }
    ASSERT_EQ(run_shell("{ " + together + "wait; }").status, 0);
    for (int i = 0; i < 8; ++i) {
        const fs::path folder = folder_ / ("p" + std::to_string(i));
        EXPECT_EQ(text_of(folder / "status"), "0\n");
        EXPECT_THAT(text_of(folder / "err"), IsEmpty());
        EXPECT_TRUE(text_of(folder / "a.png") == picture_);
    }
    EXPECT_TRUE(contents("cache") == contents("alone"));
}

TEST_F(FaultsCache, IsCompletedAfterAKill) {
    run_with("alone");
    fs::create_directory(folder_ / "cache");
    std::ofstream(folder_ / "cache/.x.table.edgesplat-1-1.tmp") << "half";
    for (int i = 0; i < 4; ++i) {
        const std::string old = cache().string();
        setenv("EDGESPLAT_CACHE", "cache", 1);  // NOLINT(concurrency-mt-unsafe)
        const pid_t child = start(kRender);
        setenv("EDGESPLAT_CACHE", old.c_str(), 1);  // NOLINT(concurrency-mt-unsafe)
        std::this_thread::sleep_for(std::chrono::milliseconds(150 + 250 * i));
        kill(child, SIGKILL);
        waitpid(child, nullptr, 0);
    }
    run_with("cache");
    EXPECT_TRUE(contents("cache") == contents("alone"));
}

}  // namespace
}  // namespace edgesplat
