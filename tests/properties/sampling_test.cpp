// Antialiased footprints and several samples per pixel, against known sums and larger pictures.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>

#include "tests/properties/scenes.h"

namespace edgesplat::test {
namespace {

const glm::dvec3 kCentre(13.6, 14.2, 13.9);
constexpr double kRadius = 9.3;
constexpr double kSigma = 1e-3;  // so thin that nothing is occluded

/// A nearly transparent ball, `distance` mm away.
Shot thin_ball(double distance, const glm::dmat3& axes = glm::dmat3(1)) {
    Shot shot;
    shot.volume = placed(std::make_shared<const Volume>(sample(sphere_scene({28, 28, 28}, kCentre, kRadius))), axes);
    shot.scene.iso_values = {0.5};
    shot.scene.materials = {{}, {{1, 1, 1}, kSigma}};
    shot.scene.lights.clear();
    const glm::dvec3 towards = glm::normalize(glm::dvec3(0.3, 1, -0.4));
    shot.camera.direction = towards;
    shot.camera.eye = shot.volume->geometry.to_world(kCentre) - distance * towards;
    shot.camera.up = {0.1, 0.2, 1};
    shot.camera.fov_y = 20;
    shot.width = shot.height = 32;
    return shot;
}

/// Optical depth times the area of a pixel at the ball, mm^2, summed over the picture.
double matter_seen(const Shot& shot, double distance) {
    const double side = 2 * distance * std::tan(shot.camera.fov_y * std::numbers::pi / 360) / shot.height;
    double sum = 0;
    for (const float tau : render_tau(shot).pixels)
        sum += static_cast<double>(tau) * side * side;
    return sum;
}

/// The same for the exact ball: extinction times volume, each part scaled by its apparent size.
double matter_there(const Shot& shot, double distance) {
    const VolumeGeometry& geometry = shot.volume->geometry;
    const glm::dvec3 forward = glm::normalize(shot.camera.direction);
    constexpr int kSteps = 40;
    double sum = 0;
    for (int i = 0; i < kSteps * kSteps * kSteps; ++i) {
        const glm::dvec3 at = glm::dvec3(i % kSteps, i / kSteps % kSteps, i / kSteps / kSteps) + 0.5;
        const glm::dvec3 from_centre = kRadius * (2.0 * at / static_cast<double>(kSteps) - 1.0);
        if (glm::length(from_centre) > kRadius) continue;
        const glm::dvec3 from_eye = geometry.to_world(kCentre + from_centre) - shot.camera.eye;
        const double z = glm::dot(forward, from_eye);
        sum += distance * distance * glm::length(from_eye) / (z * z * z);
    }
    const double cell = 8 * kRadius * kRadius * kRadius / (kSteps * kSteps * kSteps);
    return kSigma * cell * std::abs(glm::determinant(geometry.index_to_world_axes)) * sum;
}

TEST(Antialias, KeepsTheAmountOfMatterAtAnyDistance) {
    for (const glm::dmat3& axes :
         {glm::dmat3(1), glm::dmat3(glm::dvec3(1, 0, 0), glm::dvec3(0, 0.6, 0), glm::dvec3(0.2, 0, 2.5))}) {
        double worst = 0, worst_without = 0;
        // Pixels of 1.8 to 60 voxels; from nearer, the ball does not fit into the picture.
        for (double distance = 160; distance < 6000; distance *= 1.31) {
            Shot shot = thin_ball(distance, axes);
            const double ball = matter_there(shot, distance);
            worst_without = std::max(worst_without, std::abs(matter_seen(shot, distance) / ball - 1));
            shot.scene.effects.antialias = true;
            worst = std::max(worst, std::abs(matter_seen(shot, distance) / ball - 1));
        }
        std::printf("matter of a ball at any distance: error %.4f at most, %.2f without filter\n", worst,
                    worst_without);
        EXPECT_LE(worst, 0.01);
        EXPECT_GT(worst_without, 0.3) << "the filter has no effect in this test";
    }
}

TEST(Antialias, ChangesNoBitForPixelsFinerThanHalfAVoxel) {
    Shot shot = torus_shot();
    shot.width = shot.height = 160;
    const Image without = render(shot).color;
    shot.scene.effects.antialias = true;
    EXPECT_EQ(render(shot).color.pixels, without.pixels);
}

/// Layers of three voxels, alternately matter and empty. Pixels of several voxels show them as aliased bands.
Shot striped() {
    Shot shot;
    shot.volume = sampled({96, 24, 40}, [](const glm::dvec3& x) {
        return std::clamp(0.5 + 0.8 * std::sin(2 * std::numbers::pi * (0.166 * x.x + 0.02 * x.z)), 0.0, 1.0);
    });
    shot.scene.iso_values = {0.5};
    shot.scene.materials = {{}, {{1, 1, 1}, 0.02}};
    shot.scene.lights.clear();
    shot.camera = look(*shot.volume, {47, -2600, 19}, {47, 12, 19}, 6);
    shot.width = shot.height = 40;
    return shot;
}

TEST(Antialias, AveragesDetailsFinerThanAPixel) {
    Shot shot = striped();
    const Image without = render(shot).color;
    shot.scene.effects.antialias = true;
    const Image filtered = render(shot).color;
    // Half of the 24 voxels on the ray is matter.
    const double expected = -std::expm1(-0.02 * 12);
    const auto worst = [&](const Image& picture) {
        double off = 0;
        for (int y = 19; y < 21; ++y)
            for (int x = 15; x < 25; ++x)
                off = std::max(off, std::abs(static_cast<double>(picture.at(x, y, 3)) / expected - 1));
        return off;
    };
    std::printf("stripes finer than a pixel: error %.4f, %.3f without filter\n", worst(filtered), worst(without));
    EXPECT_LE(worst(filtered), 0.02);
    EXPECT_GT(worst(without), 0.3) << "the filter has no effect in this test";
}

TEST(Antialias, IsFiniteForPixelsOfAnySize) {
    for (const double distance : {3e3, 1e6, 1e9, 2e10}) {
        for (const int side : {1, 2, 5}) {
            for (const double fov : {1.0, 90.0, 170.0}) {
                Shot shot = thin_ball(distance);
                shot.scene.effects.antialias = true;
                shot.scene.materials[1].extinction = 1;
                shot.width = shot.height = side;
                shot.camera.fov_y = fov;
                shot.settings.sheet_spacing = distance > 1e8 ? 16 : 0.25;
                const Image picture = render(shot).color;
                EXPECT_TRUE(within(picture, 0, 1)) << distance << " mm, " << side << " pixels, " << fov << " degrees";
            }
        }
    }
}

TEST(Samples, GiveTheMeanOfALargerPicture) {
    Shot shot = torus_shot();
    shot.settings.saturation = 1;
    shot.scene.effects.clip.keep = {{shot.volume->geometry.to_world({14, 13, 9}), {0.3, 0.1, 1}}};
    shot.width = 40;
    shot.height = 30;
    for (const int n : {2, 3}) {
        Shot larger = shot;
        larger.scene.effects.samples = 1;
        larger.width *= n;
        larger.height *= n;
        const Image fine = render(larger).color;
        shot.scene.effects.samples = n;
        const Image picture = render(shot).color;
        double worst = 0;
        for (int y = 0; y < shot.height; ++y) {
            for (int x = 0; x < shot.width; ++x) {
                for (int c = 0; c < 4; ++c) {
                    double sum = 0;
                    for (int i = 0; i < n * n; ++i)
                        sum += static_cast<double>(fine.at(n * x + i % n, n * y + i / n, c));
                    worst = std::max(worst, std::abs(sum / (n * n) - static_cast<double>(picture.at(x, y, c))));
                }
            }
        }
        std::printf("%d x %d samples against a picture larger by the same factor: worst %.1e\n", n, n, worst);
        EXPECT_LE(worst, 2e-5);
    }
}

TEST(Samples, NarrowThePixelFilter) {
    // With n x n samples and the filter, the picture is the mean of a filtered picture n times larger.
    Shot shot = striped();
    shot.settings.saturation = 1;
    shot.scene.effects.antialias = true;
    Shot larger = shot;
    larger.width *= 2;
    larger.height *= 2;
    const Image fine = render(larger).color;
    shot.scene.effects.samples = 2;
    const Image picture = render(shot).color;
    for (int y = 0; y < shot.height; ++y)
        for (int x = 0; x < shot.width; ++x)
            EXPECT_NEAR(picture.at(x, y, 3),
                        0.25F * (fine.at(2 * x, 2 * y, 3) + fine.at(2 * x + 1, 2 * y, 3) +
                                 fine.at(2 * x, 2 * y + 1, 3) + fine.at(2 * x + 1, 2 * y + 1, 3)),
                        2e-5F);
}

TEST(Samples, KeepTheExtraOutputsAtPixelCentres) {
    Shot shot = torus_shot();
    const RenderResult one = render(shot, {.tau = true, .depth = true, .normal = true});
    shot.scene.effects.samples = 3;
    const RenderResult nine = render(shot, {.tau = true, .depth = true, .normal = true});
    EXPECT_NE(nine.color.pixels, one.color.pixels);
    EXPECT_EQ(nine.tau->pixels, one.tau->pixels);
    EXPECT_EQ(nine.depth->pixels, one.depth->pixels);
    EXPECT_EQ(nine.normal->pixels, one.normal->pixels);
}

}  // namespace
}  // namespace edgesplat::test
