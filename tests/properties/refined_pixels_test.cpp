// Settings::pixels: pictures in which some pixels are drawn and the others are interpolated.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "engine/reference/5_refine_pixels.h"
#include "shaders/shared/limits.h"
#include "tests/properties/scenes.h"

namespace edgesplat::test {
namespace {

/// The displayed value, in 8-bit steps of sRGB.
double shown(float linear) {
    const double c = std::clamp(static_cast<double>(linear), 0.0, 1.0);
    return 255 * (c < 0.0031308 ? 12.92 * c : 1.055 * std::pow(c, 1 / 2.4) - 0.055);
}

struct Difference {
    double largest = 0, rms = 0;
};

Difference shown_difference(const Image& a, const Image& b) {
    Difference out;
    double sum = 0;
    for (int y = 0; y < a.height; ++y) {
        for (int x = 0; x < a.width; ++x) {
            for (int c = 0; c < 3; ++c) {
                const double difference = std::abs(shown(a.at(x, y, c)) - shown(b.at(x, y, c)));
                out.largest = std::max(out.largest, difference);
                sum += difference * difference;
            }
        }
    }
    out.rms = std::sqrt(sum / (3.0 * a.width * a.height));
    return out;
}

/// Pictures with splats many pixels wide: from nearby, from inside, opaque, translucent, of a wall, cut.
std::vector<std::pair<std::string, Shot>> near_shots() {
    std::vector<std::pair<std::string, Shot>> shots;
    Shot torus = torus_shot();
    torus.camera = look(*torus.volume, {15, -2, 20}, {14, 9, 9}, 45);
    torus.width = 203;  // neither a multiple of a tile nor of a step
    torus.height = 158;
    shots.emplace_back("torus", torus);
    Shot inside = torus;
    inside.camera = look(*inside.volume, {22.5, 13.6, 9.4}, {19, 21, 9.4}, 90);
    inside.scene.materials = {{{0.9, 0.6, 0.4}, 3}, {}, {}};  // the hollow in the ring's matter
    shots.emplace_back("from within", inside);
    Shot cut = torus;
    cut.scene.effects.clip.remove = {{{15, 0, 0}, {1, 0.2, 0}}};
    cut.scene.background = {0, 0, 0};
    shots.emplace_back("cut", cut);
    Shot glass = torus;
    glass.scene.materials = {{{0.3, 0.3, 0.3}, 0.01}, {{0.2, 0.5, 1}, 0.1}, {{1, 0.85, 0.7}, 0.2}};
    shots.emplace_back("translucent", glass);
    Shot sliced = torus;
    sliced.settings.sheets = SheetCut::Sliced;
    sliced.settings.sheet_spacing = 1;
    sliced.width = 101;
    sliced.height = 77;
    sliced.camera = look(*torus.volume, {15, 0, 18}, {14, 7, 9}, 30);
    shots.emplace_back("sliced", sliced);
    for (auto& [name, shot] : shots)
        shot.scene.background = {0, 0, 0};
    return shots;
}

Shot with(Shot shot, PixelChoice pixels) {
    shot.settings.pixels = pixels;
    return shot;
}

TEST(RefinedPixels, MatchTheReference) {
    if (!refines_pixels()) GTEST_SKIP() << "this device draws every pixel";
    for (const auto& [name, shot] : near_shots()) {
        SCOPED_TRACE(name);
        const Image every = render(with(shot, PixelChoice::Every)).color;
        const Image refined = render(with(shot, PixelChoice::Refined)).color;
        const reference::RefinedPicture want = reference::refine_pixels(every);
        // Some pixels are interpolated, and some had to be drawn.
        const double all = static_cast<double>(every.width) * every.height;
        EXPECT_LT(static_cast<double>(want.drawn), 0.75 * all);
        EXPECT_GT(static_cast<double>(want.drawn), 0.08 * all);
        std::size_t others = 0;
        for (std::size_t i = 0; i < refined.pixels.size(); ++i)
            if (std::abs(refined.pixels[i] - want.picture.pixels[i]) > 2e-4F) ++others;
        // At the tolerance rounding decides.
        EXPECT_LE(static_cast<double>(others), 1e-2 * static_cast<double>(refined.pixels.size()));
    }
}

TEST(RefinedPixels, DifferByLessThanAStepOfEightBits) {
    if (!refines_pixels()) GTEST_SKIP() << "this device draws every pixel";
    for (const auto& [name, shot] : near_shots()) {
        SCOPED_TRACE(name);
        const Image every = render(with(shot, PixelChoice::Every)).color;
        const Image refined = render(with(shot, PixelChoice::Refined)).color;
        const Difference difference = shown_difference(refined, every);
        std::printf("%-12s largest %.3f, rms %.4f of 255\n", name.c_str(), difference.largest, difference.rms);
        EXPECT_GT(difference.largest, 0) << "every pixel was drawn";
        EXPECT_LE(difference.largest, name == "from within" ? 1.5 : 1);
        EXPECT_LE(difference.rms, 0.05);
    }
}

TEST(RefinedPixels, LeaveTheDrawnPixelsUnchanged) {
    for (const auto& [name, shot] : near_shots()) {
        SCOPED_TRACE(name);
        const Image every = render(with(shot, PixelChoice::Every)).color;
        const Image refined = render(with(shot, PixelChoice::Refined)).color;
        constexpr int kStep = static_cast<int>(shader::REFINE_STEP);
        for (int y = 0; y < every.height; y += kStep)
            for (int x = 0; x < every.width; x += kStep)
                for (int c = 0; c < 4; ++c)
                    ASSERT_NEAR(refined.at(x, y, c), every.at(x, y, c), 2e-5) << x << ", " << y;
    }
}

TEST(RefinedPixels, EvaluateFewerFootprints) {
    if (!refines_pixels()) GTEST_SKIP() << "this device draws every pixel";
    const Shot shot = near_shots().front().second;
    const auto evaluated = [&](PixelChoice pixels) {
        test_renderer().count_fragments(true);
        const RenderResult result = render(with(shot, pixels));
        test_renderer().count_fragments(false);
        return result.stats.draw_counts ? static_cast<double>(result.stats.draw_counts->fragments) : 0;
    };
    const double every = evaluated(PixelChoice::Every);
    if (every == 0) GTEST_SKIP() << "this device counts no draws";
    EXPECT_LT(evaluated(PixelChoice::Refined), 0.75 * every);
}

TEST(RefinedPixels, AreAllDrawnIfSplatsAreSmall) {
    Shot shot = torus_shot();
    shot.camera = look(*shot.volume, {15, -124, 26}, {14, 13, 9}, 40);
    EXPECT_EQ(render(with(shot, PixelChoice::Refined)).color.pixels,
              render(with(shot, PixelChoice::Every)).color.pixels);
}

TEST(RefinedPixels, DoNotChangeOtherOutputs) {
    const Shot shot = near_shots().front().second;
    const AovRequest all{.tau = true, .depth = true, .normal = true, .distance = true};
    const RenderResult refined = render(with(shot, PixelChoice::Refined), all);
    const RenderResult every = render(with(shot, PixelChoice::Every), all);
    EXPECT_EQ(refined.tau->pixels, every.tau->pixels);
    EXPECT_EQ(refined.depth->pixels, every.depth->pixels);
    EXPECT_EQ(refined.normal->pixels, every.normal->pixels);
    EXPECT_EQ(refined.distance->pixels, every.distance->pixels);
    EXPECT_EQ(test_renderer().validation_messages(), 0U);
}

/// The smallest pictures have no complete cell.
TEST(RefinedPixels, AreAllDrawnInAPictureOfAFewPixels) {
    for (const glm::ivec2& size : {glm::ivec2(1, 1), glm::ivec2(3, 2), glm::ivec2(4, 5), glm::ivec2(1, 40)}) {
        Shot shot = near_shots().front().second;
        shot.width = size.x;
        shot.height = size.y;
        const Image every = render(with(shot, PixelChoice::Every)).color;
        const Image refined = render(with(shot, PixelChoice::Refined)).color;
        const Difference difference = shown_difference(refined, every);
        EXPECT_LE(difference.largest, 1) << size.x << "x" << size.y;
        if (std::min(size.x, size.y) < 5) {
            EXPECT_EQ(refined.pixels, every.pixels) << size.x << "x" << size.y;
        }
    }
}

}  // namespace
}  // namespace edgesplat::test
