// Footprints from the table: quads in layers of sheets and tiles give the same picture, close to that of integrals.
#include <gtest/gtest.h>

#include <cstdio>
#include <string_view>

#include "engine/scene/views.h"
#include "tests/properties/scenes.h"

namespace edgesplat::test {
namespace {

Shot builtin(const char* name, const char* view) {
    const AnalyticScene scene = analytic_scene(name);
    Shot shot;
    shot.volume = std::make_shared<const Volume>(sample(scene));
    shot.scene.iso_values = scene.iso_values;
    shot.scene.materials.resize(scene.iso_values.size() + 1);
    shot.scene.materials.back() = {{1, 0.8, 0.55}, 3};
    shot.width = shot.height = 72;
    shot.camera = named_view(view, {shot.volume.get(), &shot.scene, 40, shot.width, shot.height});
    shot.settings.footprints = FootprintMode::Table;
    return shot;
}

double picture_psnr(const Image& a, const Image& b) {
    return compare_images(a, b).psnr;
}

/// The shot with sheets in layers.
Shot layered(Shot shot) {
    shot.settings.sheet_format = SheetFormat::Layers;
    return shot;
}

Shot integrated(Shot shot) {
    shot.settings.footprints = FootprintMode::Procedural;
    return shot;
}

class TableOfBuiltins : public testing::TestWithParam<const char*> {};

TEST_P(TableOfBuiltins, GivesTheSamePictureInLayersAndTiles) {
    for (const char* view : {"oblique", "close"}) {
        Shot shot = builtin(GetParam(), view);
        shot.settings.pixels = PixelChoice::Every;  // as in layers
        const Image tiles = render(shot).color, layers = render(layered(shot)).color;
        const double same = picture_psnr(tiles, layers);
        std::printf("%-10s %-8s layers against tiles %.1f dB\n", GetParam(), view, same);
        EXPECT_GE(same, 60);
        EXPECT_GT(evenness(tiles).mean * evenness(tiles).variation, 0.01) << "an empty picture shows nothing";
        // The table does not contain walls and strongly bent faces: the boxes have others, torus and vessels do not.
        const std::string_view name = GetParam();
        const double as_integrated = picture_psnr(tiles, render(integrated(shot)).color);
        if (name == "box" || name == "cube-hole") {
            EXPECT_LT(as_integrated, 90);
        } else if (name == "tilted-torus" || name == "vessels") {
            EXPECT_GT(as_integrated, 90);
        }
    }
    EXPECT_EQ(test_renderer().validation_messages(), 0U);
}

INSTANTIATE_TEST_SUITE_P(Six, TableOfBuiltins,
                         testing::Values("box", "cube-hole", "ellipsoid", "tilted-torus", "shell", "vessels"),
                         [](const auto& test) {
                             std::string name = test.param;
                             std::erase(name, '-');
                             return name;
                         });

TEST(FootprintTable, ApproximatesIntegralsForPlaneFaces) {
    // Nearby, the directions within a footprint differ, which the table ignores.
    for (const auto& [view, least] : {std::pair{"oblique", 40}, {"close", 30}}) {
        for (const char* name : {"plane", "plates", "box", "cube-hole"}) {
            const Shot shot = builtin(name, view);
            const double near = picture_psnr(render(shot).color, render(integrated(shot)).color);
            std::printf("%-10s %-8s table against integrals %.1f dB\n", name, view, near);
            EXPECT_GE(near, least) << name << " " << view;
        }
    }
}

TEST(FootprintTable, IntegratesSlicedKernels) {
    Shot shot = builtin("box", "oblique");
    shot.settings.sheets = SheetCut::Sliced;
    shot.settings.sheet_spacing = 1;
    EXPECT_EQ(render(shot).color.pixels, render(integrated(shot)).color.pixels);
}

}  // namespace
}  // namespace edgesplat::test
