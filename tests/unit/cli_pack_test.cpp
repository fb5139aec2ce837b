// `edgesplat pack`: other commands read its file, its memory is bounded, and failures leave no file.
#include <fcntl.h>
#include <gmock/gmock.h>
#include <sys/resource.h>

#include <nlohmann/json.hpp>

#include "tests/unit/cli_program.h"

namespace {

using edgesplat::CliTest;
using edgesplat::ProgramRun;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

class CliPackTest : public CliTest {
  protected:
    /// Starts the program inside the folder, without a shell.
    pid_t start(std::vector<std::string> arguments) const {
        arguments.insert(arguments.begin(), EDGESPLAT_PROGRAM);
        std::vector<char*> argv;
        for (std::string& argument : arguments)
            argv.push_back(argument.data());
        argv.push_back(nullptr);
        const pid_t child = fork();
        if (child != 0) return child;
        const int nowhere = open("/dev/null", O_RDWR);
        for (int stream = 0; stream < 3; ++stream)
            dup2(nowhere, stream);
        if (chdir(folder_.c_str()) == 0) execv(EDGESPLAT_PROGRAM, argv.data());
        _exit(127);
    }

    /// Peak memory of the program in MB while it packs.
    double peak_of(const std::string& volume) const {
        const pid_t child = start({"pack", volume, "-o", "vol.esv"});
        int status = 0;
        struct rusage usage {};
        EXPECT_EQ(wait4(child, &status, 0, &usage), child);
        EXPECT_EQ(status, 0);
        return static_cast<double>(usage.ru_maxrss) / 1024;
    }
};

TEST_F(CliPackTest, InfoDescribesPackedVolume) {
    const ProgramRun packed = run("pack builtin:phantom:100 -o vol.esv");
    ASSERT_EQ(packed.status, 0) << packed.err;
    EXPECT_THAT(packed.out, HasSubstr("vol.esv: 100 x 100 x 100 voxels as float32, 2 levels"));
    EXPECT_THAT(files(), ElementsAre("vol.esv"));

    const auto in_file = nlohmann::json::parse(run("info vol.esv --bins 64 --json -").out);
    const auto in_memory = nlohmann::json::parse(run("info builtin:phantom:100 --bins 64 --json -").out);
    for (const char* key : {"dims", "type", "spacing_mm", "directions", "origin_mm", "range", "checksum", "histogram",
                            "suggested_iso_values", "no_data"})
        EXPECT_EQ(in_file[key], in_memory[key]) << key;
    EXPECT_NEAR(in_file["mean"].get<double>(), in_memory["mean"].get<double>(), 1e-9);
    EXPECT_EQ(in_file["packed"]["levels"], nlohmann::json::parse("[[100,100,100],[50,50,50]]"));
    EXPECT_THAT(run("info vol.esv").out, HasSubstr("suggested iso-values (from level 0):"));

    const ProgramRun scene = run("scene new vol.esv -o vol.toml");
    EXPECT_EQ(scene.status, 0) << scene.err;
    EXPECT_EQ(run("scene check vol.toml").status, 0);
}

TEST_F(CliPackTest, ReportsQuantisationError) {
    const ProgramRun packed = run("pack builtin:sphere:40 -o vol.esv --quantise 16 --compress");
    ASSERT_EQ(packed.status, 0) << packed.err;
    EXPECT_THAT(packed.out, HasSubstr("as uint16"));
    EXPECT_THAT(packed.out, HasSubstr("quantised: the largest error of a sample is 7.6"));
    EXPECT_THAT(run("info vol.esv").out, HasSubstr("Quantised to 16 bits"));
    EXPECT_THAT(run("pack builtin:sphere:40 -o again.esv -q").out, IsEmpty());
}

TEST_F(CliPackTest, RefusesInvalidRequestsAndLeavesNoFile) {
    struct Case {
        const char* arguments;
        int status;
        const char* message;
    };
    ASSERT_EQ(run("pack builtin:sphere:20 -o vol.esv").status, 0);
    for (const Case& test : {
             Case{"pack builtin:sphere:20 -o vol.h5", 1, ".esv"},
             Case{"pack builtin:sphere:20", 2, "--output"},
             Case{"pack builtin:sphere:20 -o no/vol.esv", 1, "no"},
             Case{"pack missing.nrrd -o new.esv", 1, "missing.nrrd: no such file"},
             Case{"pack builtin:sphere:20 -o new.esv --quantise 12", 2, "12"},
             Case{"pack builtin:sphere:1000000 -o new.esv", 1, "2^40"},
             Case{"pack vol.esv -o new.esv", 1, "vol.esv: is a packed volume already"},
             Case{"render vol.esv -o a.png --renderer raycast", 1, "--renderer raycast needs all samples in memory"},
             Case{"render vol.esv -o a.png --renderer reference", 1, "--renderer reference needs all samples"},
             Case{"render vol.esv -o a.png --box-filter", 1, "the box filter needs all samples"},
             Case{"render vol.esv -o a.png --max-error 1%", 1, "--max-error needs all samples"},
             Case{"accuracy vol.esv --report report", 1, "accuracy needs all samples"},
             Case{"effects vol.esv", 1, "effects needs all samples"},
         }) {
        const ProgramRun result = run(test.arguments);
        EXPECT_EQ(result.status, test.status) << test.arguments;
        EXPECT_THAT(result.err, HasSubstr(test.message)) << test.arguments;
        EXPECT_THAT(files(), ElementsAre("vol.esv")) << test.arguments;
    }
}

TEST_F(CliPackTest, ChecksFreeDiskSpaceFirst) {
    if (std::filesystem::space(folder_).available > 1'100'000'000'000U) GTEST_SKIP() << "the disk is large enough";
    const ProgramRun result = run("pack builtin:sphere:10000 -o vol.esv");
    EXPECT_EQ(result.status, 1);
    EXPECT_THAT(result.err, HasSubstr("vol.esv: needs 11"));
    EXPECT_THAT(result.err, HasSubstr("MB are free"));
    EXPECT_THAT(files(), IsEmpty());
}

TEST_F(CliPackTest, InterruptLeavesNoFile) {
    bool began = false;
    const auto writing = [&] { return began = !files().empty(); };
    EXPECT_EQ(interrupted("pack builtin:sphere:320 -o vol.esv", writing), 130);
    EXPECT_TRUE(began) << "it was interrupted before it wrote anything";
    EXPECT_THAT(files(), IsEmpty());
}

TEST_F(CliPackTest, MemoryDoesNotGrowWithTheVolume) {
#if defined(__SANITIZE_ADDRESS__)
    GTEST_SKIP() << "the sanitizer keeps freed memory";
#endif
    // 256^3 samples are 64 MB as floats; packing may take an eighth of that.
    const double small = peak_of("builtin:sphere:32"), large = peak_of("builtin:sphere:256");
    EXPECT_LT(large - small, 8) << small << " and " << large << " MB";
    std::ofstream(folder_ / "voxels.raw") << std::string(256 * 256 * 256 * 2, 'a');
    const pid_t child = start({"pack", "voxels.raw", "--raw", "256x256x256:uint16:little", "-o", "raw.esv"});
    struct rusage usage {};
    int status = 0;
    ASSERT_EQ(wait4(child, &status, 0, &usage), child);
    EXPECT_EQ(status, 0);
    EXPECT_LT(static_cast<double>(usage.ru_maxrss) / 1024 - small, 8);
}

}  // namespace
