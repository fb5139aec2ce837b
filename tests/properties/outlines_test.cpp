// Smooth outlines with one ray per pixel, compared with the exact picture of 6 x 6 rays per pixel.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <string>

#include "engine/error.h"
#include "tests/properties/exact_scenes.h"

namespace edgesplat::test {
namespace {

/// A scene of exact_scene() whose truth is averaged over whole pixels.
Exact whole_pixels(const std::string& name) {
    Exact scene = exact_scene(name);
    scene.shot.width = scene.shot.height = 80;
    Scene look = scene.shot.scene;
    look.effects.samples = 6;
    reference::DirectOptions options;
    options.tolerance = 1e-2;
    const Shot& shot = scene.shot;
    scene.truth = reference::truth(builtin_scene("builtin:" + name), shot.volume->geometry, look, shot.camera,
                                   shot.width, shot.height, options)
                      .image;
    return scene;
}

Shot smooth(Shot shot) {
    shot.scene.effects.smooth_outlines = true;
    return shot;
}

/// RMS error of colour and opacity.
double rms(const Image& image, const Image& truth) {
    return compare_images(image, truth).rmse;
}

TEST(Outlines, ApproximateWholePixelsBetterThanSingleRays) {
    double sum = 0;
    const std::array scenes{"ellipsoid", "tilted-torus", "shell", "vessels"};
    for (const char* name : scenes) {
        const Exact scene = whole_pixels(name);
        const Shot& shot = scene.shot;
        const double stepped = rms(render(shot).color, scene.truth),
                     ramp = rms(render(smooth(shot)).color, scene.truth);
        const double rays =
            rms(test_renderer().raycast(shot.scene, shot.camera, shot.settings, {}, shot.width, shot.height).color,
                scene.truth);
        std::printf("%-14s rays %.4f, faces %.4f, with smooth outlines %.4f: %.2f of the rays' error\n", name, rays,
                    stepped, ramp, ramp / rays);
        EXPECT_LT(ramp, 0.7 * stepped) << name;
        sum += ramp / rays;
    }
    EXPECT_LT(sum / scenes.size(), 0.6);
}

TEST(Outlines, ShowTheCoveredShareOfThePixel) {
    const Exact scene = whole_pixels("small-ball");
    const Image image = render(smooth(scene.shot)).color;
    double worst = 0, sum = 0;
    int passed = 0;
    for (int y = 0; y < image.height; ++y) {
        for (int x = 0; x < image.width; ++x) {
            const double covered = static_cast<double>(scene.truth.at(x, y, 3));
            if (covered < 0.02 || covered > 0.98) continue;
            const double off = std::abs(static_cast<double>(image.at(x, y, 3)) - covered);
            worst = std::max(worst, off);
            sum += off;
            ++passed;
        }
    }
    ASSERT_GT(passed, 30);
    std::printf("%d pixels: mean %.4f, maximum %.3f\n", passed, sum / passed, worst);
    EXPECT_LT(sum / passed, 0.03);
    EXPECT_LT(worst, 0.15);
}

TEST(Outlines, ChangeNothingWithoutAnOutline) {
    Exact scene = exact_scene("ellipsoid");
    // Only the middle of the solid is visible.
    scene.shot.camera.fov_y = 4;
    // Two different shaders, which a compiler may round differently.
    EXPECT_LE(compare_images(render(scene.shot).color, render(smooth(scene.shot)).color).max, 1e-6);
}

TEST(Outlines, ChangeNothingWithSeveralSamples) {
    Exact scene = exact_scene("small-ball");
    scene.shot.width = scene.shot.height = 48;
    scene.shot.scene.effects.samples = 2;
    EXPECT_EQ(render(scene.shot).color.pixels, render(smooth(scene.shot)).color.pixels);
}

TEST(Outlines, ChangeNothingWithPlainKernels) {
    Exact scene = exact_scene("small-ball");
    scene.shot.settings.edges = EdgeEstimator::Off;
    EXPECT_EQ(render(scene.shot).color.pixels, render(smooth(scene.shot)).color.pixels);
}

TEST(Outlines, AreTheSameWithRefinedPixels) {
    Exact scene = exact_scene("tilted-torus");
    Shot every = smooth(scene.shot);
    every.settings.pixels = PixelChoice::Every;
    const Image refined = render(smooth(scene.shot)).color, all = render(every).color;
    EXPECT_LT(accuracy::image_error(refined, all).max, 0.02);
}

TEST(Outlines, AreRefusedInLayers) {
    Exact scene = exact_scene("small-ball");
    scene.shot.settings.sheet_format = SheetFormat::Layers;
    try {
        render(smooth(scene.shot));
        FAIL() << "layers have no outlines";
    } catch (const Error& error) {
        EXPECT_THAT(error.what(),
                    testing::AllOf(testing::HasSubstr("effects.smooth_outlines"), testing::HasSubstr("tiles")));
    }
}

}  // namespace
}  // namespace edgesplat::test
