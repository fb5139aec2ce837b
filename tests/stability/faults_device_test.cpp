// Vulkan failures in the real program: memory, submissions, waits and pipelines, one after the other; and no Vulkan at
// all. A layer (fault_layer.cpp) makes the calls fail.
#include "tests/stability/faults_program.h"

namespace edgesplat {
namespace {

using testing::AllOf;
using testing::AnyOf;
using testing::HasSubstr;
using testing::IsEmpty;

constexpr const char* kDeviceRender = "render builtin:torus:16 --size 24x24 -q -o a.png";
constexpr const char* kRaycast = "render builtin:torus:16 --size 24x24 --renderer raycast -q -o a.png";
constexpr const char* kMovie = "movie builtin:torus:16 --size 24x24 --orbit 20 --seconds .12 -q -o frames/f_%02d.png";

class FaultsDevice : public FaultsTest {
  protected:
    /// Runs the program with a layer in which the calls `first` to `last` ("ever": all from `first` on) of a kind fail.
    ProgramRun run_failing(const std::string& kind, int first, const std::string& arguments,
                           const std::string& last = "") const {
        return run_shell("VK_LAYER_PATH='" EDGESPLAT_FAULT_LAYER
                         "' VK_INSTANCE_LAYERS=VK_LAYER_EDGESPLAT_faults "
                         "EDGESPLAT_FAULT=" +
                         kind + " EDGESPLAT_FAULT_AT=" + std::to_string(first) + " EDGESPLAT_FAULT_LAST=" + last +
                         " EDGESPLAT_FAULT_COUNT=count timeout -s KILL 60 '" EDGESPLAT_PROGRAM "' " + arguments);
    }

    /// Number of calls of a kind without a failure. The picture must equal the one without the layer.
    int calls(const std::string& kind, const std::string& arguments) const {
        const ProgramRun result = run_failing(kind, 0, arguments);
        EXPECT_EQ(result.status, 0) << result.err;
        EXPECT_THAT(result.err, IsEmpty());
        const int count = std::atoi(text_of(folder_ / "count").c_str());
        EXPECT_GT(count, 0) << "the layer is not there";
        return count;
    }

    /// Distance of the tested calls: 1 for all, or larger for at most about `most` of them.
    static int step(int count, int most) { return full_faults() ? 1 : std::max(1, count / most); }

    void set_old() const {
        std::filesystem::remove_all(folder_ / "frames");
        std::ofstream(folder_ / "a.png", std::ios::trunc) << "old";
    }

    /// The old picture remains, and one message says why.
    void expect_refused(const ProgramRun& result, const std::string& words) const {
        expect_one_message(result, words);
        EXPECT_EQ(text_of(folder_ / "a.png"), "old");
        EXPECT_THAT(temporaries(), IsEmpty());
    }
};

TEST_F(FaultsDevice, OutOfMemoryIsReportedWithNumbers) {
    const int count = calls("allocate", kDeviceRender);
    for (int n = 1; n <= count; n += step(count, 8)) {
        SCOPED_TRACE(n);
        set_old();
        const ProgramRun result = run_failing("allocate", n, kDeviceRender);
        expect_refused(result, "MiB of device memory");
        EXPECT_THAT(result.err, AllOf(HasSubstr("MiB are in use here"), HasSubstr("of a heap of"),
                                      HasSubstr("--memory-budget"), HasSubstr("--size")));
    }
}

TEST_F(FaultsDevice, FailedPipelineIsAnError) {
    const int count = calls("pipeline", kDeviceRender);
    for (int n = 1; n <= count; n += step(count, 5)) {
        SCOPED_TRACE(n);
        set_old();
        // Only the result's name is compared: the text about the function differs between versions of Vulkan-Hpp.
        expect_refused(run_failing("pipeline", n, kDeviceRender), "ErrorOutOfDeviceMemory");
    }
}

TEST_F(FaultsDevice, DrawsTilesWithoutLayers) {
    ASSERT_EQ(run("render builtin:torus:16 --size 24x24 -q -o a.png").status, 0);
    const std::string whole = text_of(folder_ / "a.png");
    set_old();
    const ProgramRun tiles = run_failing("layers", 0, kDeviceRender);
    EXPECT_EQ(tiles.status, 0) << tiles.err;
    EXPECT_EQ(text_of(folder_ / "a.png"), whole);
    set_old();
    expect_refused(run_failing("layers", 0, std::string(kDeviceRender) + " --sheet-format layers"),
                   "no shaderOutputLayer (each sheet is a layer of the target), expected `tiles`");
}

class FaultsDeviceLost : public FaultsDevice, public testing::WithParamInterface<const char*> {};

TEST_P(FaultsDeviceLost, OnceIsReopenedWithTheSamePicture) {
    for (const char* command : {kDeviceRender, kRaycast}) {
        const int count = calls(GetParam(), command);
        const std::string whole = text_of(folder_ / "a.png");
        for (int n = 1; n <= count; n += step(count, command == kDeviceRender ? 5 : 2)) {
            SCOPED_TRACE(std::string(command) + ", call " + std::to_string(n));
            set_old();
            const ProgramRun result = run_failing(GetParam(), n, command);
            EXPECT_EQ(result.status, 0) << result.err;
            // While the device is opened, there is nothing to redo yet.
            EXPECT_THAT(result.err,
                        AnyOf(IsEmpty(), testing::ContainsRegex("^edgesplat: warning: the device [^\n]* was "
                                                                "lost; it is reopened[^\n]*\n$")));
            EXPECT_TRUE(text_of(folder_ / "a.png") == whole);
            EXPECT_THAT(temporaries(), IsEmpty());
        }
    }
}

TEST_P(FaultsDeviceLost, ForEverIsAnError) {
    const int count = calls(GetParam(), kDeviceRender);
    for (int n = 1; n <= count; n += step(count, 3)) {
        SCOPED_TRACE(n);
        set_old();
        ProgramRun result = run_failing(GetParam(), n, kDeviceRender, "ever");
        EXPECT_EQ(result.status, 1);
        EXPECT_THAT(result.err, AllOf(HasSubstr("was lost (ErrorDeviceLost), and again after it was reopened"),
                                      HasSubstr("--size"), HasSubstr("--device")));
        EXPECT_LE(std::count(result.err.begin(), result.err.end(), '\n'), 2) << result.err;
        EXPECT_EQ(text_of(folder_ / "a.png"), "old");
        EXPECT_THAT(temporaries(), IsEmpty());
    }
}

INSTANTIATE_TEST_SUITE_P(Faults, FaultsDeviceLost, testing::Values("submit", "wait"),
                         [](const auto& parameter) { return std::string(parameter.param); });

TEST_F(FaultsDevice, MovieSurvivesALostDeviceAndResumesAfterAnError) {
    const int count = calls("submit", kMovie);
    const auto whole = contents("frames");
    ASSERT_EQ(whole.size(), 4U);
    for (int n = 1; n <= count; n += step(count, 3)) {
        SCOPED_TRACE(n);
        set_old();
        const ProgramRun result = run_failing("submit", n, kMovie);
        EXPECT_EQ(result.status, 0) << result.err;
        EXPECT_TRUE(contents("frames") == whole);
    }
    set_old();
    EXPECT_EQ(run_failing("submit", count - 3, kMovie, "ever").status, 1);
    EXPECT_LT(contents("frames").size(), whole.size());
    EXPECT_THAT(temporaries(), IsEmpty());
    EXPECT_EQ(run(kMovie).status, 0);
    EXPECT_TRUE(contents("frames") == whole);
}

TEST_F(FaultsDevice, MissingDriverIsReportedWithItsPackage) {
    set_old();
    const std::string none = "VK_DRIVER_FILES=/none VK_ICD_FILENAMES=/none '" EDGESPLAT_PROGRAM "' ";
    expect_refused(run_shell(none + kDeviceRender), "mesa-vulkan-drivers");
    EXPECT_EQ(run_shell(none + "accuracy builtin:sphere:16 --report report").status, 1);
    const ProgramRun devices = run_shell(none + "--list-devices");
    EXPECT_THAT(devices.out + devices.err, HasSubstr("mesa-vulkan-drivers"));
    // Commands that need no device still work.
    EXPECT_EQ(run_shell(none + "info builtin:torus:16").status, 0);
    EXPECT_EQ(run_shell(none + "render builtin:torus:16 --size 8x8 --renderer reference -q -o r.png").status, 0);
}

}  // namespace
}  // namespace edgesplat
