// Invalid command lines: message, exit status, and no file is left.
#include <gmock/gmock.h>

#include "engine/image/image_file.h"
#include "tests/unit/cli_program.h"

namespace edgesplat {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;
using ::testing::StartsWith;

using Cli = CliTest;

TEST_F(Cli, HelpAndVersionSucceed) {
    const ProgramRun help = run("--help");
    EXPECT_EQ(help.status, 0);
    EXPECT_THAT(help.out, AllOf(HasSubstr("render"), HasSubstr("info"), HasSubstr("compare"), HasSubstr("footprints"),
                                HasSubstr("Examples")));
    for (const char* command : {"render", "info", "compare", "footprints"}) {
        const ProgramRun of_command = run(std::string(command) + " --help");
        EXPECT_EQ(of_command.status, 0) << command;
        EXPECT_THAT(of_command.out, HasSubstr("--help")) << command;
    }
    const ProgramRun version = run("--version");
    EXPECT_EQ(version.status, 0);
    EXPECT_THAT(version.out, StartsWith("edgesplat 0."));
}

TEST_F(Cli, RenderHelpListsOptions) {
    const std::string help = run("render --help").out;
    for (const char* option : {"--eye", "--target", "--direction", "--up", "--fov", "--view", "--voxel", "--iso",
                               "--size", "--aov", "--edges", "--footprints", "--warp", "--compare", "--json",
                               "--device", "--validation", "--sheet-spacing", "--keep-buried"})
        EXPECT_THAT(help, HasSubstr(option));
}

/// An invalid command line and words that its message must contain.
struct Misuse {
    const char* name;
    const char* arguments;
    int status;
    std::vector<const char*> words;
};

class CliMisuse : public CliTest, public ::testing::WithParamInterface<Misuse> {};

TEST_P(CliMisuse, IsRefusedInOneSentence) {
    const Misuse& misuse = GetParam();
    const ProgramRun result = run(misuse.arguments);
    EXPECT_EQ(result.status, misuse.status) << result.err;
    EXPECT_THAT(result.err, StartsWith("edgesplat: error: "));
    for (const char* word : misuse.words)
        EXPECT_THAT(result.err, HasSubstr(word));
    EXPECT_THAT(result.out, IsEmpty());
    EXPECT_THAT(files(), IsEmpty());
}

INSTANTIATE_TEST_SUITE_P(
    Cli, CliMisuse,
    ::testing::Values(
        Misuse{"NoCommand", "", 2, {"--help"}},
        Misuse{"UnknownCommand", "rendr", 2, {"'rendr'", "Did you mean render?"}},
        Misuse{"UnknownOption", "render builtin:sphere -o a.png --edgs off", 2, {"--edgs", "Did you mean --edges?"}},
        Misuse{"NoVolume", "render -o a.png", 2, {"VOLUME", "required"}},
        Misuse{"NoOutput", "render builtin:sphere", 2, {"--output", "required"}},
        Misuse{"TwoNumbers", "render builtin:sphere -o a.png --eye 1,2", 2, {"--eye", "'1,2'", "X,Y,Z"}},
        Misuse{"FourNumbers", "render builtin:sphere -o a.png --up 1,2,3,4", 2, {"--up", "'1,2,3,4'"}},
        Misuse{"Spaces", "render builtin:sphere -o a.png --up '1, 2,3'", 2, {"--up", "'1, 2,3'"}},
        Misuse{"Words", "render builtin:sphere -o a.png --eye 1,2,3mm", 2, {"--eye", "'1,2,3mm'"}},
        Misuse{"NotFinite", "render builtin:sphere -o a.png --eye 1,2,nan", 2, {"--eye", "'1,2,nan'"}},
        Misuse{"NoDirection", "render builtin:sphere -o a.png --direction 0,0,0", 1, {"--direction", "0,0,0"}},
        Misuse{"WideAngle", "render builtin:sphere -o a.png --fov 180", 2, {"--fov", "'180'", "179"}},
        Misuse{"ZeroSize", "render builtin:sphere -o a.png --size 0x10", 2, {"--size", "'0x10'", "WxH"}},
        Misuse{"UnknownStep", "render builtin:sphere -o a.png --edges sobel", 2, {"--edges", "sobel", "march"}},
        Misuse{"UnknownView", "render builtin:sphere -o a.png --view rear", 2, {"--view", "rear", "front"}},
        Misuse{"Spacing", "render builtin:sphere -o a.png --sheet-spacing 0.01", 2, {"--sheet-spacing", "0.05 to 16"}},
        Misuse{"EyeAndView", "render builtin:sphere -o a.png --eye 0,0,0 --view front", 2, {"--view", "--eye"}},
        Misuse{"UnknownAov", "render builtin:sphere -o a.png --aov tau,colour", 2, {"--aov", "colour", "tau"}},
        Misuse{"Extension", "render builtin:sphere -o a.jpg", 1, {"a.jpg", ".png or .exr"}},
        Misuse{"Folder", "render builtin:sphere -o none/a.png", 1, {"none/a.png", "does not exist"}},
        Misuse{"Unwritable", "render builtin:sphere -o /proc/a.png", 1, {"cannot write /proc/a.png"}},
        Misuse{"JsonFolder", "render builtin:sphere -o a.png --json none/a.json", 1, {"none/a.json"}},
        Misuse{"NoFile", "render none.nrrd -o a.png", 1, {"none.nrrd"}},
        Misuse{"UnknownBuiltin", "render builtin:cow -o a.png", 1, {"cow", "sphere"}},
        Misuse{"IsoOutside", "render builtin:sphere:16 -o a.png --iso 7000", 1, {"--iso 7000", "between"}},
        Misuse{
            "ColorCount", "render builtin:sphere:16 -o a.png --color 1,1,1 --color 1,0,0", 1, {"--color", "2 times"}},
        Misuse{"UnknownDevice", "render builtin:sphere:16 -o a.png --device nosuchcard", 1, {"nosuchcard"}},
        Misuse{"MaxError", "render builtin:sphere -o a.png --max-error 0", 2, {"--max-error", "'0'", "0.5%"}},
        Misuse{"MaxErrorReference",
               "render builtin:sphere:16 -o a.png --max-error 1% --renderer reference",
               1,
               {"--max-error", "--renderer splat"}},
        Misuse{"AccuracyNoReport", "accuracy builtin:sphere", 2, {"--report", "required"}},
        Misuse{"AccuracySize", "accuracy builtin:sphere --report r --size 0x4", 2, {"--size", "'0x4'"}},
        Misuse{"AccuracyTolerance", "accuracy builtin:sphere --report r --tolerance 1", 2, {"--tolerance", "'1'"}},
        Misuse{"AccuracyRepeats", "accuracy builtin:sphere --report r --repeats 0", 2, {"--repeats", "'0'"}},
        Misuse{"AccuracyFolder", "accuracy builtin:sphere --report none/r", 1, {"none", "does not exist"}},
        Misuse{"AccuracyFactor", "accuracy builtin:sphere --report r --downsample 1", 2, {"--downsample", "1"}},
        Misuse{"AccuracyCrop", "accuracy builtin:sphere --report r --crop 1,2,3", 2, {"--crop", "'1,2,3'"}},
        Misuse{"AccuracyCropOutside",
               "accuracy builtin:sphere:16 --report r --crop 0,0,0,16,3,3",
               1,
               {"crop", "16 x 16 x 16"}},
        Misuse{"AccuracyQuickFull", "accuracy builtin:sphere --report r --quick --full", 2, {"--quick", "--full"}},
        Misuse{"AccuracyQuickLarge",
               "accuracy builtin:sphere:100 --report r --quick",
               1,
               {"100 x 100 x 100 voxels: --quick measures at most 500000", "--crop 10,10,10,88,88,88"}},
        Misuse{"CompareNoFile", "compare a.png b.png", 2, {"a.png", "no such file"}}),
    [](const ::testing::TestParamInfo<Misuse>& parameter) { return std::string(parameter.param.name); });

TEST_F(Cli, CompareReportsDifferences) {
    Image image(4, 4, 3);
    write_image(folder_ / "a.exr", image);
    image.at(1, 2, 0) = 0.25F;
    write_image(folder_ / "b.exr", image);
    write_image(folder_ / "small.exr", Image(2, 2, 3));

    EXPECT_EQ(run("compare a.exr a.exr").status, 0);
    const ProgramRun differ = run("compare a.exr b.exr");
    EXPECT_EQ(differ.status, 1);
    EXPECT_THAT(differ.out, AllOf(HasSubstr("max    0.25 at pixel 1,2 channel 0"), HasSubstr("PSNR")));
    EXPECT_EQ(run("compare a.exr b.exr --max-diff 0.25").status, 0);
    EXPECT_EQ(run("compare a.exr b.exr --max-diff 0.1 --max-share 0.05").status, 1);
    EXPECT_EQ(run("compare a.exr b.exr --max-diff 0.1 --max-share 0.07").status, 0);
    EXPECT_EQ(run("compare a.exr b.exr --min-psnr 20").status, 0);
    EXPECT_EQ(run("compare a.exr b.exr --min-psnr 60").status, 1);
    EXPECT_EQ(run("compare a.exr small.exr").status, 2);

    EXPECT_EQ(run("compare a.exr b.exr --diff d.exr --gain 2").status, 1);
    EXPECT_FLOAT_EQ(read_image(folder_ / "d.exr").image.at(1, 2, 0), 0.5F);
    EXPECT_THAT(files(), ElementsAre("a.exr", "b.exr", "d.exr", "small.exr"));
}

TEST_F(Cli, WritesResultsOnlyToStdout) {
    write_image(folder_ / "a.png", Image(2, 2, 3));
    const ProgramRun result = run("compare a.png a.png");
    EXPECT_THAT(result.err, IsEmpty());
    EXPECT_THAT(result.out, Not(IsEmpty()));
}

}  // namespace
}  // namespace edgesplat
