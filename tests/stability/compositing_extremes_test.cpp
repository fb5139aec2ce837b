// Extremes of compositing: tiny and huge extinction, very many sheets and splats, few bits.
#include <algorithm>
#include <cmath>

#include "tests/stability/hazard.h"

namespace edgesplat::test {
namespace {

Shot torus_of(double extinction) {
    static const auto volume =
        std::make_shared<const Volume>(sample(torus_scene({24, 24, 14}, {11.6, 11.3, 6.4}, 6.7, 3.2)));
    Shot shot = shot_of(volume, 0.5, extinction);
    shot.scene.lights = {Light{}};
    shot.camera = look(*volume, {14, -30, 31}, {11.6, 11.3, 6.4}, 30);
    return shot;
}

constexpr SheetFormat kFormats[] = {SheetFormat::Layers, SheetFormat::Tiles};

/// A row of voxels along x, full of matter, seen from its end.
Shot row_of(int voxels, double extinction) {
    const auto row = volume_of({voxels, 5, 5}, [](const glm::ivec3&) { return 1.0F; });
    Shot shot = shot_of(row, 0.5, extinction);
    shot.camera = look(*row, {-1e5, 2, 2}, {0, 2, 2}, 1e-4);
    shot.width = shot.height = 8;
    shot.settings.saturation = 1;
    return shot;
}

TEST(CompositingExtremes, ZeroExtinctionGivesNoSplats) {
    const RenderResult result = sound(torus_of(0), "nothing");
    EXPECT_EQ(result.stats.splats_collected, 0U);
    EXPECT_EQ(middle_of(result.color, 3).most, 0);
}

TEST(CompositingExtremes, TinyExtinction) {
    for (const SheetFormat format : {SheetFormat::Layers, SheetFormat::Tiles}) {
        Shot shot = row_of(40, 1e-12);
        shot.settings.sheet_format = format;
        const RenderResult result = sound(shot, "1e-12 per mm");
        EXPECT_NEAR(middle_of(*result.tau, 0).mean / 40e-12, 1, 2e-2) << name_of(format);
        EXPECT_LE(middle_of(result.color, 3).most, 1e-7) << name_of(format);
    }
}

TEST(CompositingExtremes, SmallExtinctionsAddUp) {
    // Each splat is below half a step of 1 - x: losses in each sheet would add up to everything.
    for (const SheetFormat format : {SheetFormat::Layers, SheetFormat::Tiles}) {
        Shot shot = row_of(2000, 2e-8);
        shot.settings.sheet_format = format;
        EXPECT_NEAR(middle_of(sound(shot, "2e-8 per mm").color, 3).mean / 4e-5, 1, 0.01) << name_of(format);
    }
}

TEST(CompositingExtremes, HugeExtinction) {
    for (const SheetFormat format : kFormats) {
        Shot shot = row_of(40, 1e12);
        shot.settings.sheet_format = format;
        const RenderResult result = sound(shot, "1e12 per mm");
        EXPECT_GE(middle_of(result.color, 3).least, 1 - 1e-6) << name_of(format);
        // With opaque matter the sum of kernels is off by 1 to 1.25 % (kNarrowKernel).
        EXPECT_NEAR(middle_of(*result.tau, 0).mean / 40e12, 1, 0.0125) << name_of(format);
    }
}

TEST(CompositingExtremes, ExtinctionsWithAnOverflowingSum) {
    // 3e37 per splat, 40 splats: the sum overflows a float. Alpha must be 1, and tau must be finite.
    const RenderResult result = sound(row_of(40, 3e37), "3e37 per mm");
    EXPECT_GE(middle_of(result.color, 3).least, 1 - 1e-6);
    EXPECT_GE(middle_of(*result.tau, 0).least, 1e20) << "clamped to 1e20 per voxel";
}

TEST(CompositingExtremes, TinyExtinctionBeforeHugeExtinction) {
    const auto halves = volume_of({40, 5, 5}, [](const glm::ivec3& v) { return v.x < 20 ? 0.0F : 1.0F; });
    Shot shot = row_of(40, 1e12);
    shot.volume = halves;
    shot.scene.materials[0] = {{1, 0, 0}, 1e-12};
    shot.scene.materials[1].color = {0, 0, 1};
    const Image color = sound(shot, "1e-12 before 1e12").color;
    EXPECT_LE(middle_of(color, 0).most, 1e-6) << "nearly transparent matter shows no colour";
    EXPECT_GE(middle_of(color, 2).least, 1 - 1e-6);
}

TEST(CompositingExtremes, TenThousandSheets) {
    for (const SheetFormat format : kFormats) {
        Shot shot = row_of(2600, 1 / 2600.0);
        shot.settings.sheet_format = format;
        const RenderResult result = sound(shot, "10400 sheets");
        EXPECT_GE(result.stats.sheets, 10000U) << name_of(format);
        EXPECT_NEAR(middle_of(result.color, 3).mean, 1 - std::exp(-1.0), 6e-4) << name_of(format);
    }
}

TEST(CompositingExtremes, TenThousandSlicedSheets) {
    Shot shot = row_of(2600, 1 / 2600.0);
    shot.settings.sheets = SheetCut::Sliced;
    const RenderResult result = sound(shot, "10400 slices");
    EXPECT_GE(result.stats.sheets, 10000U);
    EXPECT_NEAR(middle_of(result.color, 3).mean, 1 - std::exp(-1.0), 3e-4);
}

TEST(CompositingExtremes, TenThousandSheetsInOneSplat) {
    // One voxel is 2600 mm deep, in sheets of a twentieth of the shortest step.
    const auto deep = volume_of(
        {2, 5, 5}, [](const glm::ivec3&) { return 1.0F; }, glm::dmat3(1300, 0, 0, 0, 1, 0, 0, 0, 1));
    Shot shot = shot_of(deep, 0.5, 1 / 2600.0);
    shot.camera = look(*deep, {-100, 2, 2}, {0, 2, 2}, 1e-4);
    shot.width = shot.height = 8;
    shot.settings.saturation = 1;
    shot.settings.sheet_spacing = 0.05;
    // The weight of border voxels is a mean over lattices, which does not fit this lattice of two voxels exactly.
    EXPECT_NEAR(middle_of(sound(shot, "a deep voxel").color, 3).mean, 1 - std::exp(-1.0), 8e-3);
}

TEST(CompositingExtremes, AThousandSplatsOnAPixelInOneSheet) {
    // A picture of one pixel: 10 x 10 x 10 splats share it, in sheets as thick as all of them.
    const auto cube = volume_of({10, 10, 10}, [](const glm::ivec3&) { return 1.0F; });
    Shot shot = shot_of(cube, 0.5, 0.1);
    shot.camera = look(*cube, {-1e4, 4.5, 4.5}, {4.5, 4.5, 4.5}, 1e-4);
    shot.width = shot.height = 1;
    shot.settings.sheet_spacing = 16;
    for (const SheetFormat format : kFormats) {
        shot.settings.sheet_format = format;
        EXPECT_NEAR(static_cast<double>(sound(shot, "a pixel").color.at(0, 0, 3)), 1 - std::exp(-1.0), 6e-4)
            << name_of(format);
    }
}

TEST(CompositingExtremes, AThousandSplatsBehindOneAnother) {
    for (const SheetFormat format : kFormats) {
        Shot shot = row_of(1000, 2e-3);
        shot.settings.sheet_format = format;
        EXPECT_NEAR(middle_of(sound(shot, "a thousand").color, 3).mean, 1 - std::exp(-2.0), 2e-4) << name_of(format);
    }
}

TEST(CompositingExtremes, NearlySaturatedPixels) {
    // 1 - alpha passes the threshold slowly: about a hundred sheets on either side of it.
    for (const SheetFormat format : kFormats) {
        for (const double saturation : {0.9, 0.99, 0.999, 0.99999, 1.0}) {
            Shot shot = row_of(400, 0.03);
            shot.settings.sheet_format = format;
            shot.settings.saturation = saturation;
            const Middle alpha = middle_of(sound(shot, "nearly saturated").color, 3);
            const double all = 1 - std::exp(-12.0);
            EXPECT_LE(alpha.most, 1) << name_of(format);
            EXPECT_GE(alpha.least, std::min(saturation, all) - 1e-5) << name_of(format) << ", " << saturation;
        }
    }
}

TEST(CompositingExtremes, OpacityNeverExceedsOne) {
    for (const double extinction : {0.3, 3.0, 30.0, 300.0, 1e6}) {
        for (const SheetFormat format : kFormats) {
            Shot shot = torus_of(extinction);
            shot.settings.sheet_format = format;
            const Image color = sound(shot, "opaque").color;
            for (const float v : color.pixels)
                ASSERT_LE(v, 1.0F) << extinction << ", " << name_of(format);
        }
    }
}

TEST(CompositingExtremes, TilesAndLayersGiveTheSamePicture) {
    for (const double extinction : {1e-6, 0.05, 2.0, 1e6}) {
        for (const SheetCut sheets : {SheetCut::Whole, SheetCut::Sliced}) {
            Shot shot = torus_of(extinction);
            shot.settings.sheets = sheets;
            const Image tiles = render(shot).color;
            shot.settings.sheet_format = SheetFormat::Layers;
            // Matter of this density shows the last 1e-7 of its kernels, which depends on rounding.
            const bool dense = extinction > 1e3;
            EXPECT_LE(compare_images(tiles, render(shot).color).max, dense ? 0.035 : 2e-3) << extinction;
            EXPECT_GE(compare_images(tiles, render(shot).color).psnr, dense ? 60 : 72) << extinction;
        }
    }
}

TEST(CompositingExtremes, RepeatsBitForBit) {
    // Independent of the order of workgroups; also in a second renderer.
    Shot shot = torus_of(0.7);
    shot.scene.iso_values = {0.2, 0.5};
    shot.scene.materials = {{}, {{0.2, 0.5, 1}, 0.1}, {{1, 0.8, 0.6}, 2}};
    for (const SheetFormat format : {SheetFormat::Layers, SheetFormat::Tiles}) {
        shot.settings.sheet_format = format;
        const Image first = render(shot).color;
        for (int i = 0; i < 3; ++i)
            EXPECT_EQ(first.pixels, render(shot).color.pixels) << name_of(format);
        Renderer other(DeviceChoice{.device = {}, .validation = true});
        other.set_volume(shot.volume);
        EXPECT_EQ(first.pixels,
                  other.render(shot.scene, shot.camera, shot.settings, shot.width, shot.height).color.pixels)
            << name_of(format);
    }
}

TEST(CompositingExtremes, OutputsOfOpaqueMatterDescribeItsSurface) {
    Shot shot = row_of(40, 1e12);
    const RenderResult result = sound(shot, "opaque");
    EXPECT_NEAR(middle_of(*result.depth, 0).mean, 1e5, 2) << "depth of the first layer, 1e5 mm away";
    shot = torus_of(1e12);
    sound(shot, "an opaque torus");
}

TEST(CompositingExtremes, OutputsOfNearlyTransparentMatter) {
    const RenderResult result = sound(torus_of(1e-30), "1e-30 per mm");
    for (const float d : result.depth->pixels)
        EXPECT_TRUE(d == 0 || (d > 10 && d < 80)) << d;
}

}  // namespace
}  // namespace edgesplat::test
