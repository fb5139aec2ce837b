// Volumes and cameras at the limits: every pixel is finite, and alpha is within [0, 1].
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "tests/properties/scenes.h"

namespace edgesplat::test {
namespace {

constexpr float kHuge = 1e9F;
constexpr AovRequest kAll{true, true, true, true};

/// Renders with all outputs; expects finite values, colours and alpha within [0, 1].
RenderResult expect_sound(const Shot& shot, const std::string& what) {
    RenderResult result = render(shot, kAll);
    EXPECT_TRUE(within(result.color, 0, 1.0001F)) << what;
    EXPECT_TRUE(shows_its_matter(result.color, *result.tau)) << what;
    EXPECT_TRUE(within(*result.tau, 0, kHuge)) << what << ": tau";
    // z of a voxel behind the eye: at most R = 1.6 voxels behind it (2 mm at 1 mm per voxel), since its kernel reaches
    // in front of it.
    EXPECT_TRUE(within(*result.depth, -2, kHuge)) << what << ": depth";
    EXPECT_TRUE(within(*result.normal, -1.0001F, 1.0001F)) << what << ": normal";
    EXPECT_TRUE(within(*result.distance, -4, 4)) << what << ": distance";
    return result;
}

double mean_alpha(const Image& color) {
    double sum = 0;
    for (std::size_t i = 3; i < color.pixels.size(); i += 4)
        sum += static_cast<double>(color.pixels[i]);
    return sum * 4 / static_cast<double>(color.pixels.size());
}

TEST(Degenerate, NonFiniteSamples) {
    Shot shot = torus_shot();
    const auto volume = std::make_shared<Volume>(*shot.volume);
    for (std::size_t i = 0; i < volume->values.size(); i += 37)
        volume->values[i] =
            i % 2 == 0 ? std::numeric_limits<float>::quiet_NaN() : std::numeric_limits<float>::infinity();
    finish_volume(*volume);
    EXPECT_GT(volume->non_finite_count, 100U);
    shot.volume = volume;
    EXPECT_GT(mean_alpha(expect_sound(shot, "NaN voxels").color), 0.05);
    std::fill(volume->values.begin(), volume->values.end(), std::numeric_limits<float>::quiet_NaN());
    const auto nothing = std::make_shared<Volume>(*volume);
    finish_volume(*nothing);
    shot.volume = nothing;
    EXPECT_EQ(mean_alpha(expect_sound(shot, "nothing but NaN").color), 0);
}

TEST(Degenerate, ExtremeEyePositions) {
    const glm::dvec3 ring = glm::dvec3(14.3, 13.6, 9.4) + glm::dvec3(0, -8.2, 0);  // the tube's middle
    struct Place {
        const char* name;
        glm::dvec3 eye, target;
    };
    const Place places[] = {{"inside an opaque voxel", ring + glm::dvec3(0.31, 0.2, -0.13), {14, 13, 9}},
                            {"on a voxel centre", glm::round(ring), {14, 20, 9}},
                            {"on a voxel centre of the hole", {14, 14, 9}, {14, 20, 9}},
                            {"between voxels", glm::round(ring) + 0.5, {14, 20, 9}},
                            {"1e-6 outside the surface", ring - glm::dvec3(0, 4.1 + 1e-6, 0), {14, 13, 9}},
                            {"1e-6 inside the surface", ring - glm::dvec3(0, 4.1 - 1e-6, 0), {14, 13, 9}},
                            {"at the grid's corner", {0, 0, 0}, {14, 13, 9}}};
    for (const double extinction : {0.05, 2.0, 100.0}) {
        for (const Place& place : places) {
            for (const double fov : {1.0, 90.0, 170.0}) {
                Shot shot = torus_shot();
                shot.scene.materials[2].extinction = extinction;
                shot.camera = look(*shot.volume, place.eye, place.target, fov);
                shot.width = shot.height = 24;
                const std::string what = fmt::format("{}, extinction {}, fov {}", place.name, extinction, fov);
                EXPECT_GT(mean_alpha(expect_sound(shot, what).color), 0.02) << what;
            }
        }
    }
}

TEST(Degenerate, DistantEyesWithATinyAngle) {
    Shot shot = torus_shot();
    shot.width = shot.height = 64;
    const glm::dvec3 target(14.3, 13.6, 9.4), way = glm::normalize(glm::dvec3(0.2, 1, -0.8));
    const auto seen_from = [&](double distance) {
        shot.camera = look(*shot.volume, target - distance * way, target, glm::degrees(2 * std::atan(16 / distance)));
        return expect_sound(shot, fmt::format("distance {}", distance)).color;
    };
    const Image near = seen_from(1e4);
    const Image far = seen_from(1e5);
    EXPECT_GT(mean_alpha(near), 0.1);
    EXPECT_GE(compare_images(near, far).psnr, 40) << "both are nearly parallel projections";
}

TEST(Degenerate, SmallestVolumes) {
    for (const glm::ivec3& dims : {glm::ivec3(1), glm::ivec3(2), glm::ivec3(1, 9, 7), glm::ivec3(9, 1, 7),
                                   glm::ivec3(9, 7, 1), glm::ivec3(1, 1, 9)}) {
        for (const auto edges :
             {EdgeEstimator::Off, EdgeEstimator::Taylor, EdgeEstimator::March, EdgeEstimator::Cubic}) {
            Shot shot;
            shot.volume = sampled(dims, [](const glm::dvec3& x) { return x.x + x.y + x.z + 1; });
            shot.scene = two_tone(0, 3);
            shot.scene.lights = {Light{}};
            shot.settings.edges = edges;
            const glm::dvec3 middle = glm::dvec3(dims - 1) / 2.0;
            shot.camera = look(*shot.volume, middle - glm::dvec3(9, 21, -13), middle, 30);
            const std::string what = fmt::format("{} x {} x {}, {}", dims.x, dims.y, dims.z, name_of(edges));
            const Image color = expect_sound(shot, what).color;
            EXPECT_GT(color.at(32, 32, 3), 0.3F) << what;
        }
    }
}

TEST(Degenerate, EmptyPictures) {
    Shot shot = torus_shot();
    shot.scene.background = {0.25, 0.5, 0.75};
    shot.camera.direction = -shot.camera.direction;
    const Image away = expect_sound(shot, "looking away").color;
    EXPECT_EQ(mean_alpha(away), 0);
    EXPECT_FLOAT_EQ(away.at(5, 7, 1), 0.5F);
    shot = torus_shot();
    for (Material& material : shot.scene.materials)
        material.extinction = 0;
    EXPECT_EQ(mean_alpha(expect_sound(shot, "transparent").color), 0);
}

}  // namespace
}  // namespace edgesplat::test
