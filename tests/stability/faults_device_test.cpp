// Vulkan that fails: memory, submissions, waits and pipelines, one after the other, in the program as it is; and no
// Vulkan at all. The calls fail in a layer (fault_layer.cpp).
#include "tests/stability/faults_program.h"

namespace edgesplat {
namespace {

using testing::AllOf;
using testing::AnyOf;
using testing::HasSubstr;
using testing::IsEmpty;

constexpr const char* kRender = "render builtin:torus:16 --size 24x24 -q -o a.png";
constexpr const char* kRaycast = "render builtin:torus:16 --size 24x24 --renderer raycast -q -o a.png";
constexpr const char* kMovie = "movie builtin:torus:16 --size 24x24 --orbit 20 --seconds .12 -q -o frames/f_%02d.png";

class FaultsDevice : public FaultsTest {
  protected:
    /// Call number `first` of a kind fails, and those up to `last` ("ever": all).
    ProgramRun run_failing(const std::string& kind, int first, const std::string& arguments,
                           const std::string& last = "") const {
        return run_shell("VK_LAYER_PATH='" EDGESPLAT_FAULT_LAYER
                         "' VK_INSTANCE_LAYERS=VK_LAYER_EDGESPLAT_faults "
                         "EDGESPLAT_FAULT=" +
                         kind + " EDGESPLAT_FAULT_AT=" + std::to_string(first) + " EDGESPLAT_FAULT_LAST=" + last +
                         " EDGESPLAT_FAULT_COUNT=count timeout -s KILL 60 '" EDGESPLAT_PROGRAM "' " + arguments);
    }

    /// Calls of a kind when nothing fails; the picture is then as it is without the layer.
    int calls(const std::string& kind, const std::string& arguments) const {
        const ProgramRun result = run_failing(kind, 0, arguments);
        EXPECT_EQ(result.status, 0) << result.err;
        EXPECT_THAT(result.err, IsEmpty());
        const int count = std::atoi(text_of(folder_ / "count").c_str());
        EXPECT_GT(count, 0) << "the layer is not there";
        return count;
    }

    /// The first call that fails, then the next: all, or as many as a suite has time for.
    static int step(int count, int most) { return full_faults() ? 1 : std::max(1, count / most); }

    void set_old() const {
        std::filesystem::remove_all(folder_ / "frames");
        std::ofstream(folder_ / "a.png", std::ios::trunc) << "old";
    }

    /// The picture is the old one, and one message says why.
    void expect_refused(const ProgramRun& result, const std::string& words) const {
        expect_one_message(result, words);
        EXPECT_EQ(text_of(folder_ / "a.png"), "old");
        EXPECT_THAT(temporaries(), IsEmpty());
    }
};

TEST_F(FaultsDevice, OutOfMemoryIsToldWithNumbers) {
    const int count = calls("allocate", kRender);
    for (int n = 1; n <= count; n += step(count, 8)) {
        SCOPED_TRACE(n);
        set_old();
        const ProgramRun result = run_failing("allocate", n, kRender);
        expect_refused(result, "MiB of device memory");
        EXPECT_THAT(result.err, AllOf(HasSubstr("MiB are in use here"), HasSubstr("of a heap of"),
                                      HasSubstr("--memory-budget"), HasSubstr("--size")));
    }
}

TEST_F(FaultsDevice, APipelineThatCannotBeMadeIsAnError) {
    const int count = calls("pipeline", kRender);
    for (int n = 1; n <= count; n += step(count, 5)) {
        SCOPED_TRACE(n);
        set_old();
        // The result by its name. Which function returned it is put in words by Vulkan-Hpp, in others by each version.
        expect_refused(run_failing("pipeline", n, kRender), "ErrorOutOfDeviceMemory");
    }
}

TEST_F(FaultsDevice, WithoutLayersDrawsWhatNeedsNone) {
    ASSERT_EQ(run("render builtin:torus:16 --size 24x24 -q -o a.png").status, 0);
    const std::string whole = text_of(folder_ / "a.png");
    set_old();
    const ProgramRun tiles = run_failing("layers", 0, kRender);
    EXPECT_EQ(tiles.status, 0) << tiles.err;
    EXPECT_EQ(text_of(folder_ / "a.png"), whole);
    set_old();
    expect_refused(run_failing("layers", 0, std::string(kRender) + " --sheet-format float"),
                   "no shaderOutputLayer (each sheet is a layer of the target), expected `tiles` there");
    expect_refused(
        run_failing("layers", 0,
                    std::string(kRender) + " --set 'lights[0].kind=directional' --set 'lights[0].shadows=true'"),
        "expected lights without shadows there");
}

class FaultsDeviceLost : public FaultsDevice, public testing::WithParamInterface<const char*> {};

TEST_P(FaultsDeviceLost, OnceItIsOpenedAnewAndThePictureIsTheSame) {
    for (const char* command : {kRender, kRaycast}) {
        const int count = calls(GetParam(), command);
        const std::string whole = text_of(folder_ / "a.png");
        for (int n = 1; n <= count; n += step(count, command == kRender ? 5 : 2)) {
            SCOPED_TRACE(std::string(command) + ", call " + std::to_string(n));
            set_old();
            const ProgramRun result = run_failing(GetParam(), n, command);
            EXPECT_EQ(result.status, 0) << result.err;
            // While it is opened there is nothing to make again.
            EXPECT_THAT(result.err,
                        AnyOf(IsEmpty(), testing::ContainsRegex("^edgesplat: warning: the device [^\n]* was "
                                                                "lost; it is opened anew[^\n]*\n$")));
            EXPECT_TRUE(text_of(folder_ / "a.png") == whole);
            EXPECT_THAT(temporaries(), IsEmpty());
        }
    }
}

TEST_P(FaultsDeviceLost, ForEverItIsAnError) {
    const int count = calls(GetParam(), kRender);
    for (int n = 1; n <= count; n += step(count, 3)) {
        SCOPED_TRACE(n);
        set_old();
        ProgramRun result = run_failing(GetParam(), n, kRender, "ever");
        EXPECT_EQ(result.status, 1);
        EXPECT_THAT(result.err, AllOf(HasSubstr("was lost (ErrorDeviceLost), and again after it was opened anew"),
                                      HasSubstr("--size"), HasSubstr("--device")));
        EXPECT_LE(std::count(result.err.begin(), result.err.end(), '\n'), 2) << result.err;
        EXPECT_EQ(text_of(folder_ / "a.png"), "old");
        EXPECT_THAT(temporaries(), IsEmpty());
    }
}

INSTANTIATE_TEST_SUITE_P(Faults, FaultsDeviceLost, testing::Values("submit", "wait"),
                         [](const auto& parameter) { return std::string(parameter.param); });

TEST_F(FaultsDevice, AMovieSurvivesALostDeviceAndGoesOnAfterAnError) {
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

TEST_F(FaultsDevice, WithoutADriverItSaysWhatToInstall) {
    set_old();
    const std::string none = "VK_DRIVER_FILES=/none VK_ICD_FILENAMES=/none '" EDGESPLAT_PROGRAM "' ";
    expect_refused(run_shell(none + kRender), "mesa-vulkan-drivers");
    EXPECT_EQ(run_shell(none + "accuracy builtin:sphere:16 --report report").status, 1);
    const ProgramRun devices = run_shell(none + "--list-devices");
    EXPECT_THAT(devices.out + devices.err, HasSubstr("mesa-vulkan-drivers"));
    // What needs no device goes on without.
    EXPECT_EQ(run_shell(none + "info builtin:torus:16").status, 0);
    EXPECT_EQ(run_shell(none + "render builtin:torus:16 --size 8x8 --renderer reference -q -o r.png").status, 0);
}

}  // namespace
}  // namespace edgesplat
