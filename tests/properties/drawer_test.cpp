// Pictures for a window: the last one equals the renderer's own, earlier ones are in time, and no unused renderer is
// kept.
#include "engine/viewer/drawer.h"

#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <thread>

#include "engine/error.h"
#include "engine/image/image_compare.h"
#include "engine/scene/ladder.h"
#include "engine/viewer/display.h"
#include "engine/volume/filters.h"
#include "engine/volume/sample_source.h"
#include "tests/properties/scenes.h"

namespace edgesplat::test {
namespace {

using viewer::Drawer;
using viewer::DrawnPicture;
using viewer::DrawRequest;
using viewer::Rung;
using Rays = Drawer::Options::Rays;

DeviceChoice device() {
    const char* wanted = std::getenv("EDGESPLAT_TEST_DEVICE");
    const std::string name = wanted == nullptr ? "" : wanted;
    return {.device = name == "gpu" ? "" : name, .validation = true};
}

Drawer::Options options(Rays rays, bool threaded = false) {
    return {.device = device(), .memory_budget = 0, .target = 150, .rays = rays, .threaded = threaded};
}

DrawRequest ball_request(double iso = 0.5) {
    static const auto volume = std::make_shared<const Volume>(
        sample(sphere_scene(glm::ivec3(48), glm::dvec3(23.5), 15, {.inside = 1, .outside = 0, .blur = 2.5})));
    DrawRequest request;
    request.volume = volume;
    request.scene.iso_values = {iso};
    request.scene.materials = {{}, {{1, 0.8, 0.6}, 8}};
    request.camera = look(*volume, {23.5, -40, 30}, {23.5, 23.5, 23.5}, 45);
    request.size = {96, 80};
    request.scene_number = static_cast<std::uint64_t>(iso * 1000);
    return request;
}

double psnr(const Image& a, const Image& b) {
    return compare_images(a, b).psnr;
}

/// Mean of the red channel.
double mean_red(const Image& image) {
    double sum = 0;
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x)
            sum += static_cast<double>(image.at(x, y, 0));
    return sum / (image.width * image.height);
}

std::vector<DrawnPicture> all(Drawer& drawer) {
    std::vector<DrawnPicture> pictures;
    while (drawer.busy())
        if (auto picture = drawer.take()) pictures.push_back(std::move(*picture));
    return pictures;
}

/// The renderer's own picture.
Image expected(const DrawRequest& request, const Settings& settings) {
    return render({request.volume, request.scene, request.camera, settings, request.size.x, request.size.y}).color;
}

TEST(Drawer, EndsWithTheRenderersOwnPicture) {
    for (const Rays rays : {Rays::Never, Rays::Always}) {
        Drawer drawer(options(rays));
        const DrawRequest request = ball_request();
        drawer.ask(request);
        const auto pictures = all(drawer);
        ASSERT_GE(pictures.size(), 2U);
        EXPECT_EQ(pictures.front().rung.rays, rays == Rays::Always);
        EXPECT_LT(pictures.front().rung.scale, 1);
        for (std::size_t i = 0; i + 1 < pictures.size(); ++i)
            EXPECT_FALSE(pictures[i].finished);
        EXPECT_TRUE(pictures.back().finished);
        EXPECT_EQ(pictures.back().rung, Rung{});
        EXPECT_GE(psnr(pictures.back().color, expected(request, request.settings)), 120);
        ASSERT_TRUE(pictures.back().coarse_error);
        EXPECT_GT(*pictures.back().coarse_error, 0);
        EXPECT_LT(*pictures.back().coarse_error, 0.1);
        EXPECT_EQ(drawer.take_error(), "");
        EXPECT_EQ(drawer.validation_messages(), 0U);
    }
}

TEST(Drawer, DrawsPlainAndBestOnlyOnRequest) {
    Drawer drawer(options(Rays::Always));
    DrawRequest request = ball_request();
    drawer.ask(request);
    all(drawer);
    EXPECT_EQ(drawer.renderers(), 1U);
    const auto bytes = drawer.device_bytes();

    request.plain = true;
    drawer.ask(request);
    const DrawnPicture both = all(drawer).back();
    ASSERT_TRUE(both.plain);
    Settings plain = request.settings;
    plain.edges = EdgeEstimator::Off;
    EXPECT_GE(psnr(*both.plain, expected(request, plain)), 120);
    EXPECT_GT(drawer.device_bytes(), bytes);

    request.plain = false;
    request.best = preset_named("accurate").settings;
    drawer.ask(request);
    const auto pictures = all(drawer);
    EXPECT_TRUE(pictures.back().best);
    EXPECT_GE(psnr(pictures.back().color, expected(request, *request.best)), 120);

    request.best.reset();
    drawer.ask(request);
    all(drawer);
    EXPECT_EQ(drawer.renderers(), 1U);
    EXPECT_EQ(drawer.validation_messages(), 0U);
}

TEST(Drawer, ShowsOnlyFinishedPicturesAfterAFinishedOneOfTheSameView) {
    for (const Rays rays : {Rays::Never, Rays::Always}) {
        Drawer drawer(options(rays));
        DrawRequest request = ball_request();
        // Sliced sheets of a quarter voxel take long enough for a coarse picture to come first.
        request.settings = preset_named("accurate").settings;
        request.size = {1000, 900};
        drawer.ask(request);
        all(drawer);
        request.camera.fov_y *= 1.01;
        drawer.ask(request);
        if (all(drawer).size() == 1) GTEST_SKIP() << "this device draws whole pictures at once";
        const auto only_finished = [&] {
            for (const DrawnPicture& picture : all(drawer))
                if (!(picture.rung == Rung{})) return false;
            return true;
        };
        request.same_view = request.plain = true;
        drawer.ask(request);
        EXPECT_TRUE(only_finished());
        request.plain = false;
        request.settings.sheet_spacing = 1;
        ++request.scene_number;
        drawer.ask(request);
        EXPECT_TRUE(only_finished());
        request.settings = preset_named("accurate").settings;
        // An unfinished picture is not kept.
        request.same_view = false;
        request.camera.fov_y *= 1.01;
        drawer.ask(request);
        EXPECT_FALSE(drawer.take()->finished);
        request.same_view = true;
        drawer.ask(request);
        EXPECT_FALSE(only_finished());
        request.same_view = false;
        drawer.ask(request);
        EXPECT_FALSE(only_finished());
        EXPECT_EQ(drawer.validation_messages(), 0U);
    }
}

TEST(Drawer, DrawsOnePictureWithTheNewIsoValueInMotion) {
    for (const Rays rays : {Rays::Never, Rays::Always}) {
        Drawer drawer(options(rays));
        drawer.ask(ball_request(0.5));
        all(drawer);
        DrawRequest request = ball_request(0.25);
        request.moving = true;
        drawer.ask(request);
        const auto pictures = all(drawer);
        ASSERT_EQ(pictures.size(), 1U);
        // A lower iso-value gives a larger ball, which is brighter in total.
        const double now = mean_red(expected(request, request.settings));
        const double before = mean_red(expected(ball_request(0.5), request.settings));
        EXPECT_GT(now, 1.1 * before);
        EXPECT_LT(std::abs(mean_red(pictures.front().color) - now), 0.3 * (now - before));
        EXPECT_EQ(drawer.validation_messages(), 0U);
    }
}

TEST(Drawer, CastsNoRaysIfTheyCannotShowTheScene) {
    Drawer drawer(options(Rays::Always));
    DrawRequest request = ball_request();
    request.moving = true;
    request.scene.effects.fog = Fog{};
    request.scene_number = 77;
    drawer.ask(request);
    const auto pictures = all(drawer);
    ASSERT_EQ(pictures.size(), 1U);
    EXPECT_FALSE(pictures.front().rung.rays);
    EXPECT_EQ(drawer.take_error(), "");
}

TEST(Drawer, DrawsTheNewestRequest) {
    Drawer drawer(options(Rays::Never, true));
    DrawRequest large = ball_request();
    large.size = {900, 900};
    drawer.ask(large);
    std::this_thread::sleep_for(std::chrono::milliseconds(30));
    const auto number = drawer.ask(ball_request(0.3));
    std::optional<DrawnPicture> last;
    const auto deadline = std::chrono::steady_clock::now() + std::chrono::minutes(5);
    while (drawer.busy() && std::chrono::steady_clock::now() < deadline) {
        if (auto picture = drawer.take()) last = std::move(picture);
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    ASSERT_TRUE(last);
    EXPECT_EQ(last->number, number);
    EXPECT_TRUE(last->finished);
    const DrawRequest request = ball_request(0.3);
    EXPECT_GE(psnr(last->color, expected(request, request.settings)), 120);
    EXPECT_EQ(drawer.take_error(), "");
    EXPECT_EQ(drawer.validation_messages(), 0U);
}

TEST(Drawer, ReportsAnErrorAndDrawsTheNextPicture) {
    Drawer drawer(options(Rays::Never));
    DrawRequest request = ball_request();
    request.scene.materials.pop_back();
    drawer.ask(request);
    EXPECT_TRUE(all(drawer).empty());
    EXPECT_NE(drawer.take_error().find("materials"), std::string::npos);
    EXPECT_EQ(drawer.take_error(), "");
    drawer.ask(ball_request());
    EXPECT_TRUE(all(drawer).back().finished);
}

TEST(Drawer, ChoosesLevelsCoarseEnoughToEstimateInEveryPicture) {
    Volume volume;
    volume.geometry.dims = {192, 192, 192};
    volume.values = {0};
    const int level = Drawer::coarsest_level(volume, true);
    EXPECT_LE(level_geometry(volume.geometry, level).voxel_count(), std::size_t{1} << 17U);
    EXPECT_EQ(Drawer::coarsest_level(volume, false), 0);
    volume.geometry.dims = {40, 40, 40};
    EXPECT_EQ(Drawer::coarsest_level(volume, true), 0);
}

TEST(Interruption, StopsThePictureAndKeepsTheRendererUsable) {
    DrawRequest request = ball_request();
    request.scene.effects.samples = 2;  // the interruption is polled between samples, too
    const Image whole = expected(request, request.settings);
    int asked = 0;
    test_renderer().set_interruption([&] { return ++asked >= 2; });
    EXPECT_THROW(expected(request, request.settings), Interrupted);
    EXPECT_EQ(asked, 2);
    test_renderer().set_interruption({});
    EXPECT_EQ(expected(request, request.settings).pixels, whole.pixels);
    EXPECT_EQ(test_renderer().validation_messages(), 0U);
}

}  // namespace
}  // namespace edgesplat::test
