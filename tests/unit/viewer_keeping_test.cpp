#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>

#include "engine/error.h"
#include "engine/scene/scene_file.h"
#include "engine/viewer/display.h"
#include "engine/viewer/flight_recorder.h"
#include "engine/viewer/keeping.h"
#include "engine/viewer/preferences.h"

namespace edgesplat::viewer {
namespace {

namespace fs = std::filesystem;

class Kept : public testing::Test {
  protected:
    void SetUp() override {
        folder_ = fs::temp_directory_path() /
                  ("edgesplat-kept-" + std::string(testing::UnitTest::GetInstance()->current_test_info()->name()));
        fs::remove_all(folder_);
        fs::create_directories(folder_);
    }
    void TearDown() override { fs::remove_all(folder_); }
    fs::path folder_;
};

TEST_F(Kept, PreferencesRoundTrip) {
    Preferences p;
    p.width = 900;
    p.height = 700;
    p.target = 40;
    p.collisions = false;
    p.device = "lava";
    remember(p, "builtin:sphere");
    remember(p, "builtin:torus");
    remember(p, "builtin:sphere");
    EXPECT_EQ(p.recent, (std::vector<std::string>{"builtin:sphere", "builtin:torus"}));
    const fs::path path = folder_ / "new folder" / "fly.toml";
    write_preferences(p, path);
    EXPECT_EQ(read_preferences(path), p);
}

TEST_F(Kept, IgnoresInvalidPreferences) {
    const fs::path path = folder_ / "fly.toml";
    std::ofstream(path) << "width = -4\nspeed = nan\nheight = \"tall\"\nturn = 2.0\nrecent = [3, \"a\"]\n";
    Preferences expected;
    expected.turn = 2;
    expected.recent = {"a"};
    EXPECT_EQ(read_preferences(path), expected);
    std::ofstream(path) << "not toml at all [[[";
    EXPECT_EQ(read_preferences(path), Preferences{});
    EXPECT_EQ(read_preferences(folder_ / "missing.toml"), Preferences{});
}

TEST_F(Kept, LimitsRecentFiles) {
    Preferences p;
    for (int i = 0; i < 40; ++i)
        remember(p, "builtin:sphere:" + std::to_string(8 + i));
    ASSERT_EQ(p.recent.size(), kMostRecent);
    EXPECT_EQ(p.recent.front(), "builtin:sphere:47");
}

TEST_F(Kept, FreePathSkipsExistingFiles) {
    EXPECT_EQ(free_path(folder_, "picture", ".png"), folder_ / "picture-1.png");
    std::ofstream(folder_ / "picture-1.png") << "x";
    EXPECT_EQ(free_path(folder_, "picture", ".png"), folder_ / "picture-2.png");
    const auto being_written = [&](const fs::path& path) { return path == folder_ / "picture-2.png"; };
    EXPECT_EQ(free_path(folder_, "picture", ".png", being_written), folder_ / "picture-3.png");
}

TEST_F(Kept, ForgetsMissingFiles) {
    Preferences p;
    const auto there = (folder_ / "there.nrrd").string(), gone = (folder_ / "gone.nrrd").string();
    std::ofstream(there) << "x";
    for (const std::string& path : {there, gone, std::string("builtin:sphere")})
        remember(p, path);
    remove_missing(p);
    EXPECT_EQ(p.recent, (std::vector<std::string>{"builtin:sphere", there}));
}

TEST_F(Kept, SavedSceneFindsVolumeFromItsFolder) {
    std::ofstream(folder_ / "v.nrrd") << "x";
    fs::create_directories(folder_ / "scenes");
    Volume volume;
    volume.name = (folder_ / "v.nrrd").string();
    SceneDocument document;
    document.volume.path = "v.nrrd";  // from another working folder
    document.iso_values = {1};
    save_scene(document, volume, folder_ / "scenes" / "a.toml");
    const SceneDocument back = read_scene_file(folder_ / "scenes" / "a.toml");
    EXPECT_EQ(back.volume.path, "../v.nrrd");
    EXPECT_THROW(save_scene(document, volume, folder_ / "a.png"), Error);
    EXPECT_THROW(save_scene(document, volume, folder_ / "missing" / "a.toml"), Error);
}

Camera flown(double t) {
    const double angle = 0.3 * std::sin(t);
    return {{20 * t, 5 * std::sin(t), std::cos(0.7 * t)}, {std::cos(angle), std::sin(angle), 0.1}, {0, 0, 1}, 60};
}

TEST(FlightRecorder, PathFollowsFlight) {
    FlightRecorder recorder;
    recorder.step(flown(0), 0.02);  // not yet recording
    recorder.start();
    constexpr double kStep = 1.0 / 30;
    for (int i = 0; i <= 300; ++i)
        recorder.step(flown(i * kStep), kStep);
    recorder.stop();
    recorder.step(flown(99), kStep);
    EXPECT_NEAR(recorder.seconds(), 10, 1e-9);
    const CameraPath path = recorder.path(0.2);
    EXPECT_LT(path.keys.size(), 100U);
    double most = 0, turned = 0;
    for (int i = 0; i <= 300; ++i) {
        const Camera was = flown(i * kStep), is = camera_at(path, i * kStep);
        most = std::max(most, glm::length(was.eye - is.eye));
        turned = std::max(turned, glm::length(glm::normalize(was.direction) - glm::normalize(is.direction)));
    }
    // Pieces are fitted one by one; the curve through all of them exceeds the tolerance of each slightly.
    EXPECT_LT(most, 0.8);
    EXPECT_LT(turned, 0.03);
}

TEST(FlightRecorder, RefusesEmptyFlight) {
    FlightRecorder recorder;
    EXPECT_THROW(recorder.path(1), Error);
    recorder.start();
    recorder.step(flown(0), 0.1);
    EXPECT_TRUE(recorder.empty());
    EXPECT_THROW(recorder.path(1), Error);
}

TEST(Display, EncodesLikePng) {
    Image image(3, 1, 4);
    const float values[3] = {0.0F, 0.2140411F, 1.0F};
    for (int x = 0; x < 3; ++x)
        for (int c = 0; c < 3; ++c)
            image.at(x, 0, c) = values[x];
    image.at(0, 0, 1) = std::nanf("");
    image.at(2, 0, 2) = 7;
    const ScreenPicture shown = screen_picture(image);
    EXPECT_EQ(shown.pixels, (std::vector<std::uint8_t>{0, 0, 0, 255, 128, 128, 128, 255, 255, 255, 255, 255}));
    // All 256 levels round-trip.
    for (int level = 0; level < 256; ++level) {
        const double s = level / 255.0;
        const double linear = s <= 0.04045 ? s / 12.92 : std::pow((s + 0.055) / 1.055, 2.4);
        Image one(1, 1, 3);
        one.at(0, 0, 0) = static_cast<float>(linear);
        EXPECT_EQ(screen_picture(one).pixels[0], level);
    }
}

TEST(Display, SharpeningMarksDifferences) {
    Image edges(4, 1, 3), plain(4, 1, 3);
    edges.at(2, 0, 0) = 1;
    const ScreenPicture shown = sharpening_picture(edges, plain);
    EXPECT_EQ(shown.pixels[0], 0);
    EXPECT_GT(shown.pixels[8], 200);  // red marks a strong difference, over faint grey of the picture
    EXPECT_LT(shown.pixels[10], 16);
    EXPECT_THROW(sharpening_picture(edges, Image(3, 1, 3)), Error);
}

TEST(Display, ComparesUpscaledPictureAtFullSize) {
    Image small(2, 2, 3), large(8, 8, 3);
    EXPECT_EQ(rms_after_upscaling(small, large), 0);
    for (float& v : large.pixels)
        v = 1;
    EXPECT_NEAR(rms_after_upscaling(small, large), 1, 1e-12);
    for (float& v : small.pixels)
        v = 1;
    EXPECT_EQ(rms_after_upscaling(small, large), 0);
}

}  // namespace
}  // namespace edgesplat::viewer
