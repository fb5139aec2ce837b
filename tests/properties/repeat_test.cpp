// A repeated picture is the same, whatever was drawn, created and freed in between.
#include <gtest/gtest.h>

#include "tests/properties/scenes.h"

namespace edgesplat::test {
namespace {

/// The ways to draw: each runs other passes.
struct Way {
    const char* name;
    void (*set)(Shot&);
};

constexpr Way kWays[] = {
    {"Tiles", [](Shot&) {}},
    {"EveryPixel", [](Shot& s) { s.settings.pixels = PixelChoice::Every; }},
    {"Layers", [](Shot& s) { s.settings.sheet_format = SheetFormat::Layers; }},
    {"SlicedSheets", [](Shot& s) { s.settings.sheets = SheetCut::Sliced; }},
    {"Plain", [](Shot& s) { s.settings.edges = EdgeEstimator::Off; }},
    {"Shadows",
     [](Shot& s) {
         s.scene.lights = {directional_light({-1, -0.3, 1.2})};
         s.scene.lights[0].shadows = true;
     }},
};

Renderer renderer_of(const Shot& shot) {
    Renderer renderer({.device = test_renderer().device().name, .validation = true});
    renderer.set_volume(shot.volume);
    return renderer;
}

RenderResult picture(Renderer& renderer, const Shot& shot) {
    RenderResult result = renderer.render(shot.scene, shot.camera, shot.settings, shot.width, shot.height);
    EXPECT_EQ(result.stats.validation_messages, 0U);
    return result;
}

class Repeat : public testing::TestWithParam<Way> {
  protected:
    Repeat() { GetParam().set(shot_); }
    Shot shot_ = torus_shot();
};

TEST_P(Repeat, MatchesAFreshRendererAfterAFlight) {
    Renderer renderer = renderer_of(shot_);
    for (int i = 0; i < 4; ++i) {
        shot_.camera.eye += glm::dvec3(0.2, 0.3, -0.1);
        EXPECT_GT(picture(renderer, shot_).stats.submissions, 0U);
    }
    Renderer fresh = renderer_of(shot_);
    EXPECT_TRUE(picture(renderer, shot_).color.pixels == picture(fresh, shot_).color.pixels);
}

TEST_P(Repeat, GivesTheSamePictureAfterOtherSizes) {
    Renderer fresh = renderer_of(shot_);
    const RenderResult expected = picture(fresh, shot_);
    Renderer renderer = renderer_of(shot_);
    for (int i = 0; i < 3; ++i) {
        EXPECT_TRUE(picture(renderer, shot_).color.pixels == expected.color.pixels);
        // Buffers and images are freed and created, possibly with the same handles.
        Shot other = shot_;
        other.width = 40 + 30 * i;
        other.scene.iso_values = {0.4};
        other.scene.materials = {{}, {{1, 0.2, 0.1}, 2}};
        picture(renderer, other);
        EXPECT_TRUE(picture(renderer, shot_).color.pixels == expected.color.pixels);
        const Shot ball = ball_over_plate_shot();
        renderer.set_volume(ball.volume);
        picture(renderer, ball);
        renderer.set_volume(shot_.volume);
    }
}

INSTANTIATE_TEST_SUITE_P(Ways, Repeat, testing::ValuesIn(kWays),
                         [](const auto& parameter) { return std::string(parameter.param.name); });

TEST(RepeatOnAGpu, WaitsOnceForTheDeviceIfChunksArePredicted) {
    // Small chunks, so that there are several.
    const auto opened = [](const Shot& shot) {
        Renderer renderer({.device = test_renderer().device().name, .validation = true, .profile = "generic"});
        renderer.set_volume(shot.volume);
        return renderer;
    };
    Shot shot = torus_shot();
    shot.settings.pixels = PixelChoice::Every;
    Renderer renderer = opened(shot);
    const RenderResult first = picture(renderer, shot), again = picture(renderer, shot);
    EXPECT_TRUE(again.color.pixels == first.color.pixels);
    EXPECT_EQ(again.stats.submissions, 1U);
    // Many chunks after a picture without any.
    Shot away = shot, many = shot;
    away.camera.direction = -away.camera.direction;
    many.width = many.height = 24;
    Renderer fresh = opened(shot);
    const RenderResult expected = picture(fresh, many);
    picture(renderer, away);
    const RenderResult unforeseen = picture(renderer, many);
    EXPECT_TRUE(unforeseen.color.pixels == expected.color.pixels);
    EXPECT_GT(unforeseen.stats.submissions, 1U);
    const RenderResult foreseen = picture(renderer, many);
    EXPECT_TRUE(foreseen.color.pixels == expected.color.pixels);
    EXPECT_EQ(foreseen.stats.submissions, 1U);
    // A sheet larger than a chunk may be: the renderer does not retry in vain.
    Shot thick = many;
    thick.settings.sheet_spacing = 16;
    picture(renderer, thick);
    const RenderResult settled = picture(renderer, thick), later = picture(renderer, thick);
    EXPECT_TRUE(later.color.pixels == settled.color.pixels);
    EXPECT_EQ(later.stats.submissions, 2U);
}

TEST(RepeatOfRays, GivesTheSamePicture) {
    const Shot shot = torus_shot();
    Renderer renderer = renderer_of(shot);
    const auto cast = [&](const Camera& camera) {
        return renderer.raycast(shot.scene, camera, shot.settings, {}, shot.width, shot.height);
    };
    const RenderResult first = cast(shot.camera);
    Camera moved = shot.camera;
    moved.eye += glm::dvec3(1, 0, 0);
    EXPECT_FALSE(cast(moved).color.pixels == first.color.pixels);
    const RenderResult again = cast(shot.camera);
    EXPECT_EQ(again.stats.submissions, 1U);
    EXPECT_TRUE(again.color.pixels == first.color.pixels);
}

TEST(RepeatOfCounts, GivesTheSameCounts) {
    Shot shot = torus_shot();
    shot.settings.sheet_format = SheetFormat::Layers;
    Renderer renderer = renderer_of(shot);
    picture(renderer, shot);
    renderer.count_fragments(true);
    const RenderResult first = picture(renderer, shot), again = picture(renderer, shot);
    if (!first.stats.draw_counts) GTEST_SKIP() << "this device counts no draws";
    EXPECT_GT(first.stats.draw_counts->fragments, 0U);
    EXPECT_EQ(again.stats.draw_counts->fragments, first.stats.draw_counts->fragments);
    EXPECT_EQ(again.stats.draw_counts->vertices, first.stats.draw_counts->vertices);
    renderer.count_fragments(false);
    EXPECT_FALSE(picture(renderer, shot).stats.draw_counts.has_value());
}

}  // namespace
}  // namespace edgesplat::test
