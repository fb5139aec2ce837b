// Renderer::count_fragments: the counts are consistent, and counting changes nothing else.
#include <gtest/gtest.h>

#include "engine/scene/views.h"
#include "engine/volume/analytic_volumes.h"
#include "tests/properties/test_renderer.h"

namespace edgesplat {
namespace {

test::Shot sphere() {
    test::Shot shot;
    shot.volume = std::make_shared<const Volume>(builtin_volume("builtin:sphere:24"));
    shot.scene.iso_values = analytic_scene("sphere").iso_values;
    shot.scene.materials = {{}, {.extinction = 8}};
    shot.camera = named_view("front", {shot.volume.get(), &shot.scene, 45, shot.width, shot.height});
    return shot;
}

TEST(DrawCounts, ExistOnRequestAndChangeNoPixel) {
    const test::Shot shot = sphere();
    const RenderResult plain = test::render(shot);
    EXPECT_FALSE(plain.stats.draw_counts);
    EXPECT_FALSE(plain.stats.dirty_share);

    test::test_renderer().count_fragments(true);
    const RenderResult counted = test::render(shot);
    test::test_renderer().count_fragments(false);
    EXPECT_EQ(counted.color.pixels, plain.color.pixels);
    ASSERT_TRUE(counted.stats.dirty_share);
    EXPECT_GT(*counted.stats.dirty_share, 0);
    EXPECT_LE(*counted.stats.dirty_share, 1);
    if (!counted.stats.draw_counts) GTEST_SKIP() << "this device counts no draws";
    EXPECT_GE(counted.stats.draw_counts->fragments, counted.stats.draw_counts->shaded);
    EXPECT_GT(counted.stats.draw_counts->shaded, 0U);
    EXPECT_FALSE(test::render(shot).stats.draw_counts);
    EXPECT_EQ(test::test_renderer().validation_messages(), 0U);
}

TEST(DrawCounts, ExcludeSaturatedPixels) {
    test::Shot shot = sphere();
    shot.settings.opaque = OpaqueMatter::Kernels;  // a surface closes a pixel whatever the saturation
    const auto shaded = [&] {
        test::test_renderer().count_fragments(true);
        const RenderResult result = test::render(shot);
        test::test_renderer().count_fragments(false);
        return result.stats.draw_counts;
    };
    const auto closing = shaded();
    shot.settings.saturation = 1;
    const auto open = shaded();
    if (!closing || !open) GTEST_SKIP() << "this device counts no draws";
    EXPECT_LT(closing->shaded, open->shaded);
}

TEST(DrawCounts, PipelinesAreCreatedOnce) {
    const test::Shot shot = sphere();
    (void)test::render(shot);
    const RenderResult again = test::render(shot);
    EXPECT_EQ(again.stats.pipelines_made, 0U);
    EXPECT_EQ(again.stats.pipeline_milliseconds, 0);
}

}  // namespace
}  // namespace edgesplat
