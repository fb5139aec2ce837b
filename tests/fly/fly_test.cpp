// Plays scripts in the navigation app: display, motion, measuring, saving and error messages.
#include "tests/fly/fly_program.h"

#include <cstdlib>

namespace edgesplat {
namespace {

namespace fs = std::filesystem;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

TEST_F(FlyTest, OpensBuiltinSceneWithoutArguments) {
    fly("settle\nexpect volume == builtin:cube-hole\nexpect finished == yes\nexpect error == none\n"
        "expect level == 0\nexpect scale == 1\nexpect rays == no\nscreenshot a.png\n",
        "");
    const Image shown = image("a.png");
    EXPECT_EQ(shown.width, 480);
    EXPECT_EQ(shown.height, 320);
}

TEST_F(FlyTest, SavedSceneRendersStandstillPicture) {
    fly("settle\nkey O\nmove 400 150\npress left\ndrag 440 120 6\nrelease left\nwheel 4\nframes 40\nsettle\n"
        "expect finished == yes\npicture shown.png\nsave kept.toml\n");
    const ProgramRun rendered = run("render kept.toml -o rendered.png");
    ASSERT_EQ(rendered.status, 0) << rendered.err;
    const Image shown = image("shown.png"), again = image("rendered.png");
    EXPECT_GE(compare_images(shown, again).psnr, 60);
    const Image black(again.width, again.height, again.channels);
    EXPECT_LT(compare_images(black, again).psnr, 20);  // there is something in it
}

TEST_F(FlyTest, WipeShowsPlainLeftAndEdgesRight) {
    fly("settle\nkey O\nsettle\npicture edges.png\nkey Space\nsettle\nexpect show == plain\npicture plain.png\n"
        "key X\nsettle\nexpect show == wipe\nexpect wipe == 0.5\nmove 360 100\npress left\ndrag 410 140 4\nrelease "
        "left\n"
        "settle\nexpect wipe > 0.6\nexpect wipe < 0.8\npicture wipe.png\nkey H\nsettle\nexpect show == sharpening\n"
        "picture sharpened.png\nkey H\nexpect show == edges\n");
    const Image edges = image("edges.png"), plain = image("plain.png"), wipe = image("wipe.png");
    EXPECT_LT(compare_images(edges, plain).psnr, 40);
    // Compare without the labels above the picture and without the divider's line and knob.
    const int width = wipe.width, middle = static_cast<int>(0.708 * width);
    const auto equal = [&](const Image& other, int first, int last) {
        return compare_images(columns(wipe, first, last), columns(other, first, last)).psnr;
    };
    EXPECT_GE(equal(plain, 0, middle - 12), 60);
    EXPECT_GE(equal(edges, middle + 12, width), 60);
    EXPECT_LT(equal(edges, 0, middle - 12), 45);
    EXPECT_LT(compare_images(image("sharpened.png"), edges).psnr, 40);
}

TEST_F(FlyTest, KeepsPictureUntilNextIsComplete) {
    // Every frame draws one picture. Between two modes, none may be coarse or shown as the other mode.
    std::string script = "size 1100 800\nsettle\n";
    for (const char* key : {"Space", "Space", "X", "H", "H", "B", "B"}) {
        script += std::string("key ") + key + "\n";
        for (int i = 0; i < 4; ++i)
            script += "frames 1\nexpect level == 0\nexpect scale == 1\nexpect rays == no\nexpect moving == no\n";
        script += "settle\n";
    }
    fly(script + "key Space\nsettle\nexpect visible == plain\n", "builtin:torus");
}

TEST_F(FlyTest, DrawsOnlyShownPictures) {
    fly("settle\nexpect renderers == 1\nkey X\nsettle\nexpect renderers >= 2\nkey X\nsettle\nexpect renderers == 1\n");
}

TEST_F(FlyTest, PicksAndMeasuresSurface) {
    // A ball of radius 20 in the middle of 64^3 voxels of 1 mm; its nearest point is at the picture's centre.
    fly("settle\nhold Ctrl\nclick 360 147\nlet Ctrl\nexpect picks == 1\nexpect pick.value > 0.45\n"
        "expect pick.value < 0.55\nkey M\nclick 360 187\nexpect picks == 2\nexpect ruler > 1\nexpect ruler < 30\n"
        "expect ruler.uncertainty >= 0\nexpect ruler.uncertainty < 1\nclick 242 2\nexpect picks == 2\n"
        "expect message == no surface there\nkey Delete\nexpect picks == 0\n",
        "builtin:sphere:64");
}

TEST_F(FlyTest, DoubleClickFliesToTargetAndHomeReturns) {
    fly("settle\nexpect eye.y < -22\ndouble 360 147\nframes 90\nsettle\nexpect eye.y > -15\nkey Home\nframes "
        "120\nsettle\n"
        "expect eye.y < -22\nexpect finished == yes\n",
        "builtin:sphere:64");
}

TEST_F(FlyTest, WallsStopFlight) {
    fly("settle\nkey F\nexpect mode == fly\nexpect collisions == on\nstep 0.1\nhold W\nframes 120\nlet W\nexpect room "
        "> 0\n"
        "expect room < 3\nkey C\nexpect collisions == off\nhold W\nframes 20\nlet W\nexpect room < 0\n",
        "builtin:sphere:64");
}

TEST_F(FlyTest, FollowsGuidedPath) {
    fly("settle\nkey G\nclick 335 147\nclick 380 147\nframes 2\nexpect path > 0\nexpect message has guided path\nkey "
        "Enter\n"
        "frames 20\nexpect path.position > 0\nkey Escape\nsettle\nexpect finished == yes\n",
        "builtin:sphere:64");
}

TEST_F(FlyTest, SavesRecordedFlightAsMovie) {
    fly("settle\nkey Ctrl+R\nmove 400 150\npress left\ndrag 460 150 30\nrelease left\nframes 30\nkey Ctrl+R\n"
        "expect recorded > 0.5\nsave flown.toml\n");
    const std::string scene = text_of(folder_ / "flown.toml");
    EXPECT_THAT(scene, HasSubstr("[[movie.path]]"));
    const ProgramRun movie = run("movie flown.toml -o frames/%04d.png --size 32x24 --fps 5");
    EXPECT_EQ(movie.status, 0) << movie.err;
}

TEST_F(FlyTest, GamepadFliesAndChangesPicture) {
    fly("settle\nkey F\nexpect mode == fly\nexpect eye.y < -1\nsave before.toml\nsticks 0 1 0 0 0\nframes 20\n"
        "sticks 0 0 0 0 0\nframes 1\nsave after.toml\nkey PadX\nexpect show == plain\nkey PadX\nexpect show == edges\n"
        "key PadB\nexpect show == plain\nkey PadB\nexpect show == wipe\nkey PadB\nexpect show == sharpening\n"
        "key PadB\nexpect show == edges\nkey PadA\nexpect mode == orbit\nkey PadStart\nframes 2\n"
        "expect message has picture-1.png\nkey PadStart\nframes 2\nexpect message has picture-2.png\n"
        "key PadY\nframes 80\nsave home.toml\n");
    const auto eye = [&](const char* name) {
        const std::string text = text_of(folder_ / name);
        const std::size_t at = text.find("eye = ");
        return text.substr(at, text.find('\n', at) - at);
    };
    EXPECT_NE(eye("before.toml"), eye("after.toml"));
    EXPECT_EQ(eye("before.toml"), eye("home.toml"));
    EXPECT_EQ(image("picture-2.png").width, image("picture-1.png").width);
}

TEST_F(FlyTest, ChoosesLookByName) {
    fly("size 900 700\nsettle\nexpect iso_values > 1\ntap scene.look\nframes 2\ntap scene.ct-skull\nframes 2\nsettle\n"
        "expect error == none\nexpect iso_values == 1\nexpect iso == 280\nkey Ctrl+Z\nframes 1\nexpect iso_values > "
        "1\n",
        "builtin:phantom:32");
}

TEST_F(FlyTest, ShowsAndHidesMatterOfAScan) {
    std::ofstream labels(folder_ / "labels.nrrd", std::ios::binary), scan(folder_ / "scan.nrrd", std::ios::binary);
    labels << "NRRD0004\ntype: uint8\ndimension: 3\nsizes: 24 24 24\nencoding: raw\n\n";
    scan << "NRRD0004\ntype: uint8\ndimension: 3\nsizes: 24 24 24\nencoding: raw\n\n";
    for (int z = 0; z < 24; ++z)
        for (int y = 0; y < 24; ++y)
            for (int x = 0; x < 24; ++x) {
                const double from = std::hypot(x - 11.5, y - 11.5, z - 11.5);
                scan.put(static_cast<char>(std::lround(std::clamp(40 * (10 - from), 0.0, 120.0))));
                labels.put(static_cast<char>(from > 10 ? 0 : x < 8 ? 2 : x < 16 ? 5 : 0));
            }
    labels.close();
    scan.close();
    std::ofstream(folder_ / "both.toml") << "iso_values = [60]\n[volume]\npath = \"scan.nrrd\"\n"
                                            "segmentation = \"labels.nrrd\"\n";
    fly("size 640 760\nsettle\nframes 2\npicture all.png\ntap scene.Labels\nframes 2\ntap scene.labels.5\nframes 2\n"
        "settle\nexpect error == none\npicture some.png\ntap scene.labels.others\nframes 2\nsettle\n"
        "expect error == none\npicture one.png\nsave one.toml\nkey Ctrl+Z\nframes 2\nkey Ctrl+Z\nframes 2\nsettle\n"
        "picture again.png\n",
        "both.toml");
    EXPECT_THAT(text_of(folder_ / "one.toml"), HasSubstr("only = [\"2\"]"));
    EXPECT_LT(compare_images(image("all.png"), image("some.png")).psnr, 40);
    EXPECT_LT(compare_images(image("some.png"), image("one.png")).psnr, 40);
    EXPECT_GT(compare_images(image("all.png"), image("again.png")).psnr, 60);
}

TEST_F(FlyTest, ShowsAndHidesLabels) {
    std::ofstream file(folder_ / "labels.nrrd", std::ios::binary);
    file << "NRRD0004\ntype: uint8\ndimension: 3\nsizes: 24 24 24\nencoding: raw\n\n";
    for (int z = 0; z < 24; ++z)
        for (int y = 0; y < 24; ++y)
            for (int x = 0; x < 24; ++x) {
                const int in = std::min({x, y, z, 23 - x, 23 - y, 23 - z});
                file.put(static_cast<char>(in < 3 ? 0 : x < 8 ? 2 : x < 16 ? 5 : 9));
            }
    file.close();
    fly("size 640 760\nsettle\nframes 2\npicture all.png\ntap scene.Labels\nframes 2\ntap scene.labels.5\nframes 2\n"
        "settle\nexpect error == none\npicture some.png\nsave some.toml\nkey Ctrl+Z\nframes 2\nsettle\n"
        "picture again.png\ntap scene.labels.fade5\nframes 2\nsettle\nexpect error == none\npicture faded.png\n"
        "save faded.toml\ntap scene.labels.5\nframes 2\nsettle\nsave hidden.toml\nkey Ctrl+Z\nframes 2\nsettle\nkey "
        "Ctrl+Z\n"
        "frames 2\nsettle\npicture unfaded.png\ntap scene.labels.own_colours\nframes 2\nsettle\nexpect error == none\n"
        "expect iso > 0\nsave numbers.toml\n",
        "labels.nrrd");
    EXPECT_THAT(text_of(folder_ / "some.toml"), HasSubstr("hide = [\"5\"]"));
    EXPECT_THAT(text_of(folder_ / "numbers.toml"), HasSubstr("labels = false"));
    EXPECT_LT(compare_images(image("all.png"), image("some.png")).psnr, 40);
    EXPECT_GT(compare_images(image("all.png"), image("again.png")).psnr, 60);
    EXPECT_LT(compare_images(image("all.png"), image("faded.png")).psnr, 40);
    EXPECT_GT(compare_images(image("all.png"), image("unfaded.png")).psnr, 60) << "each tap is one step";
    EXPECT_LT(compare_images(image("some.png"), image("faded.png")).psnr, 40);
    EXPECT_THAT(text_of(folder_ / "faded.toml"),
                AllOf(HasSubstr("hide = [\"5\"]"), HasSubstr("only = [\"5\"]"), HasSubstr("opacity = 0.5")));
    EXPECT_THAT(text_of(folder_ / "hidden.toml"), AllOf(HasSubstr("hide = [\"5\"]"), Not(HasSubstr("opacity = "))));
}

TEST_F(FlyTest, CutsAVolumeByAnother) {
    std::ofstream(folder_ / "two.toml")
        << "iso_values = [0.5]\n[volume]\npath = \"builtin:box:20\"\n[[volumes]]\n"
           "volume.path = \"builtin:sphere:20\"\nvolume.transform = [1,0,0,0, 0,1,0,-9, "
           "0,0,1,0, 0,0,0,1]\n[camera]\nview = \"front\"\n";
    fly("size 640 760\nsettle\nkey O\nframes 2\npicture both.png\ntap scene.Volumes\nframes 2\ntap "
        "scene.volume1.cut\nframes 2\n"
        "settle\nexpect error == none\nexpect volumes_shown == 1\npicture cut.png\nsave cut.toml\nkey Ctrl+Z\nframes "
        "2\n"
        "settle\npicture before.png\nkey Ctrl+Y\nframes 2\nsettle\nexpect error == none\npicture redone.png\n",
        "two.toml");
    EXPECT_LT(compare_images(image("both.png"), image("cut.png")).psnr, 40);
    EXPECT_GT(compare_images(image("before.png"), image("both.png")).psnr, 60);
    EXPECT_GT(compare_images(image("redone.png"), image("cut.png")).psnr, 60);
    const ProgramRun rendered = run("render cut.toml -o rendered.png");
    ASSERT_EQ(rendered.status, 0) << rendered.err;
    EXPECT_GT(compare_images(image("rendered.png"), image("cut.png")).psnr, 60);
}

TEST_F(FlyTest, ResizesAndMinimises) {
    fly("settle\nsize 700 500\nsettle\nexpect finished == yes\nscreenshot large.png\nsize 0 0\nframes 5\nsize 333 241\n"
        "settle\nexpect finished == yes\nscreenshot small.png\nkey Tab\nexpect panels == off\nsettle\nkey F1\n"
        "expect help == on\nframes 3\nscreenshot help.png\n");
    EXPECT_EQ(image("large.png").width, 700);
    EXPECT_EQ(image("small.png").height, 241);
    EXPECT_LT(compare_images(image("small.png"), image("help.png")).psnr, 30);
}

TEST_F(FlyTest, ReopensLostDevices) {
    const ProgramRun result = try_to_fly(
        "settle\npicture before.png\nlose window\nframes 2\nsettle\nexpect finished == yes\nexpect error == none\n"
        "picture after.png\nlose pictures\nsize 484 320\nsettle\nsize 480 320\nsettle\nexpect finished == yes\n"
        "expect error == none\npicture again.png\n",
        "builtin:torus:32");
    EXPECT_EQ(result.status, 0) << result.err;
    EXPECT_THAT(result.err, testing::MatchesRegex("edgesplat: warning: the device .* was lost; it is reopened.*\n"));
    EXPECT_GE(compare_images(image("before.png"), image("after.png")).psnr, 60);
    EXPECT_GE(compare_images(image("before.png"), image("again.png")).psnr, 60);
}

TEST_F(FlyTest, ReportsUnreadableFileAndKeepsScene) {
    std::ofstream(folder_ / "broken.nrrd") << "NRRD0004\ntype: nonsense\n\n";
    fly("settle\ndrop broken.nrrd\nframes 3\nexpect error has broken.nrrd\nexpect volume == builtin:torus:32\n"
        "expect finished == yes\ndrop builtin:sphere:24\nframes 2\nsettle\nexpect volume == builtin:sphere:24\n");
}

TEST_F(FlyTest, FailedExpectationNamesFileAndLine) {
    const ProgramRun result = try_to_fly("frames 1\nexpect show == plain\n", "builtin:sphere:16");
    EXPECT_EQ(result.status, 1);
    EXPECT_THAT(result.err, HasSubstr("script.txt:4: expect: show is edges, expected == plain"));
    const ProgramRun unknown = try_to_fly("expect nothing == plain\n", "builtin:sphere:16");
    EXPECT_EQ(unknown.status, 1);
    EXPECT_THAT(unknown.err, HasSubstr("'nothing' is not a value"));
    EXPECT_EQ(try_to_fly("", "--size 0x5").status, 2);
    const ProgramRun missing = try_to_fly("open missing.nrrd\n", "builtin:sphere:16");
    EXPECT_EQ(missing.status, 1);
    EXPECT_THAT(missing.err, HasSubstr("missing.nrrd"));
}

TEST_F(FlyTest, ReportsMissingScreen) {
    const ProgramRun result =
        run_shell("env -u DISPLAY -u WAYLAND_DISPLAY '" EDGESPLAT_FLY "' --no-preferences builtin:sphere:16");
    EXPECT_EQ(result.status, 1);
    EXPECT_THAT(result.err, HasSubstr("no screen"));
    EXPECT_EQ(run_shell("'" EDGESPLAT_FLY "' --headless builtin:sphere:16").status, 2);
}

TEST_F(FlyTest, ManualListsEveryKeyAndCommand) {
    const ProgramRun help = run_shell("'" EDGESPLAT_FLY "' --script-help");
    EXPECT_EQ(help.status, 0);
    EXPECT_THAT(help.out, HasSubstr("Space"));
    EXPECT_THAT(text_of(EDGESPLAT_SOURCE_DIR "/docs/fly.md"), HasSubstr(help.out));
}

TEST_F(FlyTest, RemembersOpenedFiles) {
    std::ofstream(folder_ / "script.txt") << "size 480 320\nopen builtin:sphere:16\nframes 1\n";
    const ProgramRun result = run_shell("env XDG_CONFIG_HOME=settings '" EDGESPLAT_FLY
                                        "' --headless --validation --script script.txt builtin:torus:16");
    EXPECT_EQ(result.status, 0) << result.err;
    const std::string kept = text_of(folder_ / "settings" / "edgesplat" / "fly.toml");
    EXPECT_THAT(kept, HasSubstr("builtin:sphere:16"));
    EXPECT_THAT(kept, HasSubstr("width = 480"));
}

TEST_F(FlyTest, FliesThroughRealNose) {
    const char* data = std::getenv("EDGESPLAT_DATA");
    const fs::path volume = fs::path(data == nullptr ? "" : data) / "cranium_ct" / "cranium.nhdr";
    if (data == nullptr || !fs::exists(volume)) GTEST_SKIP() << "EDGESPLAT_DATA names no folder with cranium_ct";
    std::ofstream(folder_ / "nose.toml") << "iso_values = [-400]\n[volume]\npath = \"" << volume.string()
                                         << "\"\n[camera]\nvoxel = true\neye = [128, 148, 14]\n"
                                            "direction = [0, 1, 0.05]\nup = [0, 0, 1]\nfov = 90\n";
    fly("settle\nexpect mode == fly\nexpect finished == yes\nexpect room > 0\nhold W\nframes 60\nlet W\nexpect room > "
        "0\n"
        "key X\nsettle\nexpect show == wipe\nmove 360 100\npress left\ndrag 410 100 5\nrelease left\nexpect wipe > "
        "0.6\n"
        "screenshot wipe.png\nkey X\nsettle\nkey M\nclick 330 120\nclick 390 170\nexpect picks == 2\nexpect ruler > "
        "0.5\n"
        "expect ruler < 80\nexpect ruler.uncertainty < 2\nkey O\nsettle\npicture shown.png\nsave kept.toml\n"
        "size 420 300\nsettle\nsize 0 0\nframes 3\nsize 480 320\nsettle\nexpect finished == yes\n",
        "nose.toml");
    const ProgramRun rendered = run("render kept.toml -o rendered.png");
    ASSERT_EQ(rendered.status, 0) << rendered.err;
    EXPECT_GE(compare_images(image("shown.png"), image("rendered.png")).psnr, 60);
}

class FlyScript : public FlyTest, public testing::WithParamInterface<std::string> {};

TEST_P(FlyScript, MeetsExpectations) {
    const ProgramRun result =
        run_shell("'" EDGESPLAT_FLY "' --headless --no-preferences --validation --script '" EDGESPLAT_SOURCE_DIR
                  "/tests/scripts/" +
                  GetParam() + ".txt'");
    EXPECT_EQ(result.status, 0) << result.err;
    EXPECT_EQ(result.err, "");
}

std::vector<std::string> scripts() {
    std::vector<std::string> names;
    if (!fs::exists(EDGESPLAT_SOURCE_DIR "/tests/scripts")) return names;
    for (const auto& entry : fs::directory_iterator(EDGESPLAT_SOURCE_DIR "/tests/scripts"))
        if (entry.path().extension() == ".txt") names.push_back(entry.path().stem().string());
    std::ranges::sort(names);
    return names;
}

INSTANTIATE_TEST_SUITE_P(All, FlyScript, testing::ValuesIn(scripts()), [](const auto& tested) { return tested.param; });
GTEST_ALLOW_UNINSTANTIATED_PARAMETERIZED_TEST(FlyScript);

}  // namespace
}  // namespace edgesplat
