// Shadows and ambient occlusion in pictures.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "tests/properties/scenes.h"

namespace edgesplat::test {
namespace {

constexpr double kTop = 5.4, kShadowRadius = 8;
const glm::dvec3 kShadowBall(22, 24, 18);

/// The first hit of a pixel's ray in ball_over_plate_shot().
struct Hit {
    bool ball = false, plate = false;
    glm::dvec3 place{0}, normal{0};
    double to_silhouette = 0;  ///< of the ball: how far the ray passes inside (< 0) or outside, mm
};

Hit first_hit(const Shot& shot, int x, int y) {
    const CameraFrame frame = camera_frame(shot.camera);
    const double side = 2 * frame.tan_half_y / shot.height;
    const glm::dvec3 u = glm::normalize(frame.forward + (x + 0.5 - 0.5 * shot.width) * side * frame.right -
                                        (y + 0.5 - 0.5 * shot.height) * side * frame.up);
    const glm::dvec3 v = kShadowBall - frame.eye;
    const double along = glm::dot(v, u), off = glm::length(v - along * u);
    Hit hit;
    hit.to_silhouette = off - kShadowRadius;
    if (off < kShadowRadius) {
        hit.ball = true;
        hit.place = frame.eye + (along - std::sqrt(kShadowRadius * kShadowRadius - off * off)) * u;
        hit.normal = (hit.place - kShadowBall) / kShadowRadius;
        return hit;
    }
    hit.place = frame.eye + (kTop - frame.eye.z) / u.z * u;
    hit.plate = u.z < 0 && std::min({hit.place.x, hit.place.y, 47 - hit.place.x, 47 - hit.place.y}) > 3;
    hit.normal = {0, 0, 1};
    return hit;
}

TEST(Shadows, FallInTheRightPlaceAndDarkenNothingElse) {
    for (const bool point : {false, true}) {
        Shot shot = ball_over_plate_shot();
        Light& light = shot.scene.lights[0];
        if (point) {
            light.kind = Light::Kind::Point;
            light.position = kShadowBall - glm::dvec3(30, 9, -36);
        }
        const Image with = render(shot).color;
        light.shadows = false;
        const Image without = render(shot).color;
        int shadow = 0, lit = 0, ball = 0;
        for (int y = 0; y < shot.height; ++y)
            for (int x = 0; x < shot.width; ++x) {
                const Hit hit = first_hit(shot, x, y);
                ASSERT_LE(with.at(x, y, 0), without.at(x, y, 0) + 1e-4F);
                if (!(hit.ball || hit.plate) || std::abs(hit.to_silhouette) < 1.5) continue;
                const glm::dvec3 l = glm::normalize(point ? light.position - hit.place : light.direction);
                const double cosine = glm::dot(hit.normal, l);
                const double share =
                    static_cast<double>(with.at(x, y, 0)) / std::max(static_cast<double>(without.at(x, y, 0)), 1e-6);
                if (hit.ball) {
                    if (cosine < 0.25) continue;
                    ++ball;
                    EXPECT_NEAR(static_cast<double>(with.at(x, y, 0)), light.intensity * cosine, 0.08);
                    continue;
                }
                const glm::dvec3 v = kShadowBall - hit.place;
                const double from_border = glm::length(v - glm::dot(v, l) * l) - kShadowRadius;
                // Light is evaluated 1.5 voxels above the plate, and kernels reach as far again.
                if (from_border > 3.2) {
                    ++lit;
                    EXPECT_GT(share, 0.98) << x << ' ' << y;
                } else if (from_border < -3.2) {
                    ++shadow;
                    EXPECT_LT(share, 0.05) << x << ' ' << y;
                }
            }
        EXPECT_GT(lit, 1000);
        EXPECT_GT(shadow, 100);
        EXPECT_GT(ball, 300);
    }
}

TEST(Shadows, AreCastOnceForAllEyes) {
    Shot shot = ball_over_plate_shot();
    const auto cast_now = [](const RenderResult& r) {
        return std::ranges::any_of(r.stats.passes, [](const PassTime& p) { return p.name == "2c_cast_shadows"; });
    };
    shot.scene.lights[0].direction.x = -0.9;
    EXPECT_TRUE(cast_now(render(shot)));
    shot.camera.eye.x += 20;
    const RenderResult again = render(shot);
    EXPECT_FALSE(cast_now(again));
    EXPECT_EQ(again.stats.setup_milliseconds, 0);
    EXPECT_EQ(again.stats.validation_messages, 0U);
    shot.scene.lights[0].direction.x = -0.8;
    EXPECT_TRUE(cast_now(render(shot)));
}

TEST(Shadows, OfTwoColouredLightsAddUp) {
    Shot shot = ball_over_plate_shot();
    Light red = shot.scene.lights[0], blue = red;
    red.color = {1, 0, 0};
    blue.color = {0, 0, 1};
    blue.direction = {1, 0.4, 1};
    shot.scene.lights = {red, blue};
    const Image both = render(shot).color;
    shot.scene.lights = {red};
    const Image first = render(shot).color;
    shot.scene.lights = {blue};
    const Image second = render(shot).color;
    float largest = 0;
    for (std::size_t i = 0; i < both.pixels.size(); i += 4) {
        largest = std::max(
            {largest, std::abs(both.pixels[i] - first.pixels[i]), std::abs(both.pixels[i + 2] - second.pixels[i + 2])});
    }
    EXPECT_LE(largest, 1e-5F);
}

TEST(Occlusion, ScalesWithItsStrength) {
    Shot shot = ball_over_plate_shot();
    shot.scene.ambient = 1;
    shot.scene.lights = {Light{}};
    shot.scene.lights[0].intensity = 0;
    const Image open = render(shot).color;
    const auto occluded = [&](double strength) {
        shot.scene.effects.occlusion = AmbientOcclusion{.strength = strength, .radius = 12};
        return render(shot).color;
    };
    const Image none = occluded(0), half = occluded(0.5), full = occluded(1);
    EXPECT_EQ(none.pixels, open.pixels);
    float darkest = 1, off = 0;
    for (std::size_t i = 0; i < open.pixels.size(); ++i) {
        EXPECT_LE(full.pixels[i], open.pixels[i] + 1e-5F);
        off = std::max(off, std::abs(half.pixels[i] - 0.5F * (full.pixels[i] + open.pixels[i])));
        if (open.pixels[i] > 0.5F) darkest = std::min(darkest, full.pixels[i] / open.pixels[i]);
    }
    EXPECT_LE(off, 1e-4F);
    EXPECT_LT(darkest, 0.6F) << "under the ball it must be dark";
}

/// Matter with random samples, cut by a plane or with a part removed.
Shot cut_block(bool hole) {
    Shot shot;
    std::uint32_t state = 1;
    shot.volume = sampled(glm::ivec3(32), [&](const glm::dvec3&) {
        state = state * 1664525U + 1013904223U;
        return 0.6 + 0.4 * (state >> 8U) / 16777216.0;
    });
    shot.scene.iso_values = {0.5};
    shot.scene.materials = {{}, {{1, 1, 1}, 4}};
    shot.scene.ambient = 0.4;
    shot.scene.lights = {directional_light({0.5, 0.3, 1})};
    if (hole)
        shot.scene.effects.clip.remove = {{{10, 10, 18.3}, {0, 0, -1}}};
    else
        shot.scene.effects.clip.keep = {{{10, 10, 18.3}, {0.05, -0.1, 1}}};
    shot.camera = look(*shot.volume, {15.5, 2, 70}, {15.5, 15.5, 18}, 20);
    return shot;
}

TEST(Shadows, StartAtTheCutOfClippedMatter) {
    // Unoccluded light reaches a cut fully, independent of the matter's own gradients.
    for (const bool hole : {false, true}) {
        Shot shot = cut_block(hole);
        const Image open = render(shot).color;
        shot.scene.lights[0].shadows = true;
        const Image shadowed = render(shot).color;
        shot.scene.lights[0].shadows = false;
        shot.scene.effects.occlusion = AmbientOcclusion{.strength = 1, .radius = 8};
        const Image occluded = render(shot).color;
        float least = 1, worst_shadow = 0, worst_occlusion = 0;
        for (int y = 20; y < 44; ++y)
            for (int x = 20; x < 44; ++x) {
                least = std::min(least, open.at(x, y, 0));
                worst_shadow = std::max(worst_shadow, std::abs(shadowed.at(x, y, 0) - open.at(x, y, 0)));
                worst_occlusion = std::max(worst_occlusion, std::abs(occluded.at(x, y, 0) - open.at(x, y, 0)));
            }
        std::printf("cut in the light: error of shadows %s, of occlusion %s\n", std::to_string(worst_shadow).c_str(),
                    std::to_string(worst_occlusion).c_str());
        EXPECT_GT(least, 0.5F);
        EXPECT_LE(worst_shadow, 0.01F);
        EXPECT_LE(worst_occlusion, 0.01F);
    }
}

}  // namespace
}  // namespace edgesplat::test
