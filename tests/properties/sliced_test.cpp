// Sliced sheets: closed forms, repeatability, saturation, and volumes at the limits.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "tests/properties/scenes.h"

namespace edgesplat::test {
namespace {

/// Alpha in the middle of a uniform box, seen along `direction` (index space) from far away, minus the closed form.
double slab_error(const glm::dmat3& axes, double sheet_spacing, const glm::dvec3& direction, Settings settings) {
    constexpr int kSize = 16;
    Shot shot;
    shot.volume = sampled(
        glm::ivec3(kSize), [](const glm::dvec3&) { return 1.0; }, axes);
    const double length = glm::length(axes * direction) /
                          std::max({std::abs(direction.x), std::abs(direction.y), std::abs(direction.z)}) * kSize;
    shot.scene = two_tone(0, 1 / length);
    shot.settings = settings;
    shot.settings.sheets = SheetCut::Sliced;
    shot.settings.sheet_spacing = sheet_spacing;
    shot.settings.saturation = 1;
    shot.camera = look(*shot.volume, glm::dvec3(7.5) - 300.0 * direction, glm::dvec3(7.5), 0.3);
    shot.width = shot.height = 16;
    const Image color = render(shot).color;
    double worst = 0;
    for (int y = 5; y < 11; ++y)
        for (int x = 5; x < 11; ++x)
            worst = std::max(worst, std::abs(static_cast<double>(color.at(x, y, 3)) - (1 - std::exp(-1.0))));
    return worst;
}

TEST(SlicedSlab, AbsorbsByTheClosedFormAtEverySheetSpacing) {
    const glm::dmat3 thick(glm::dvec3(0.4, 0, 0), glm::dvec3(0, 0.7, 0), glm::dvec3(0, 0, 3));
    const glm::dmat3 oblique(glm::dvec3(0.9, 0.2, 0.1), glm::dvec3(0.2, -1.1, 0.15), glm::dvec3(0.1, 0.3, 1.7));
    const Settings faces;
    Settings paper, off;
    paper.warp = WarpFamily::Paper;
    off.edges = EdgeEstimator::Off;
    double worst = 0;
    for (const double spacing : {0.25, 0.5, 1.0, 2.0, 4.0}) {
        for (const Settings& settings : {faces, paper, off}) {
            worst = std::max(worst, slab_error(glm::dmat3(1), spacing, {0, 1, 0}, settings));
            worst = std::max(worst, slab_error(glm::dmat3(1), spacing, {0.2, 1, -0.1}, settings));
        }
        for (const glm::dvec3& direction : {glm::dvec3(1, 0, 0), glm::dvec3(0, 1, 0), glm::dvec3(0, 0, 1)}) {
            worst = std::max(worst, slab_error(thick, spacing, direction, faces));
            worst = std::max(worst, slab_error(oblique, spacing, direction, faces));
        }
    }
    std::printf("slab, sliced: error of alpha up to %.1e\n", worst);
    // The kernel's own ripple (7e-5 in 3-D), and single precision over up to some hundred sheets.
    EXPECT_LE(worst, 8e-4);
}

constexpr WarpFamily kWarps[] = {WarpFamily::Face, WarpFamily::Paper};

Shot everything() {
    Shot shot = torus_shot();
    shot.settings.footprints = FootprintMode::Procedural;
    shot.settings.sheets = SheetCut::Sliced;
    shot.settings.sheet_spacing = 0.5;
    shot.width = shot.height = 48;
    return shot;
}

TEST(Sliced, RepeatsBitForBit) {
    for (const WarpFamily warp : kWarps) {
        Shot shot = everything();
        shot.settings.warp = warp;
        const Image first = render(shot).color;
        Shot other = shot;
        other.settings.sheets = SheetCut::Whole;
        render(other);
        EXPECT_EQ(render(shot).color.pixels, first.pixels);
    }
}

TEST(Sliced, SaturationChangesNoMoreThanItsThreshold) {
    Shot shot = everything();
    shot.scene.materials[2].extinction = 6;
    shot.settings.saturation = 1;
    const Image all = render(shot).color;
    for (const double saturation : {0.9, 0.99, 0.999}) {
        shot.settings.saturation = saturation;
        const Image some = render(shot).color;
        EXPECT_LE(compare_images(all, some).max, 1 - saturation + 1e-5) << saturation;
    }
}

TEST(Sliced, TauDoesNotDependOnSheets) {
    Shot shot = everything();
    const Image sliced = render_tau(shot);
    shot.settings.sheets = SheetCut::Whole;
    const Image whole = render_tau(shot);
    double peak = 0;
    for (const float v : whole.pixels)
        peak = std::max(peak, static_cast<double>(v));
    EXPECT_LE(compare_images(sliced, whole).max, 1e-5 * peak);
}

/// Expects finite outputs, and colours and alpha within [0, 1].
void expect_sound_slices(const Shot& shot, const std::string& what) {
    const RenderResult result = render(shot, {true, true, true, true});
    EXPECT_TRUE(within(result.color, 0, 1.0001F)) << what;
    EXPECT_TRUE(shows_its_matter(result.color, *result.tau)) << what;
    EXPECT_TRUE(within(*result.tau, 0, 1e9F)) << what << ": tau";
    // Slices lie in front of the eye.
    EXPECT_TRUE(within(*result.depth, -1e-3F, 1e9F)) << what << ": depth";
    EXPECT_TRUE(within(*result.normal, -1.0001F, 1.0001F)) << what << ": normal";
    EXPECT_TRUE(within(*result.distance, -4, 4)) << what << ": distance";
}

TEST(Sliced, GivesFiniteNumbersForDegenerateVolumes) {
    struct Grid {
        glm::ivec3 dims;
        bool constant;
    };
    for (const auto& [dims, constant] :
         {Grid{glm::ivec3(1), true}, Grid{glm::ivec3(2), false}, Grid{glm::ivec3(2), true}, Grid{{9, 1, 5}, false},
          Grid{glm::ivec3(8), true}}) {
        for (const WarpFamily warp : kWarps) {
            Shot shot;
            shot.volume = sampled(dims, [&](const glm::dvec3& x) { return constant ? 1.0 : x.x + x.y + x.z; });
            shot.scene = two_tone(0.2, 3);
            shot.scene.lights = {Light{}};
            shot.settings = everything().settings;
            shot.settings.warp = warp;
            shot.width = shot.height = 24;
            const glm::dvec3 middle = glm::dvec3(dims - 1) / 2.0;
            const std::string what = fmt::format("{} x {} x {}, {}", dims.x, dims.y, dims.z, name_of(warp));
            shot.camera = look(*shot.volume, middle - glm::dvec3(9, 21, -13), middle, 30);
            expect_sound_slices(shot, what);
            shot.camera = look(*shot.volume, glm::dvec3(0), glm::dvec3(1, 2, 0.5), 90);
            expect_sound_slices(shot, what + ", from a voxel");
        }
    }
}

TEST(Sliced, GivesFiniteNumbersForExtremeEyePositions) {
    const glm::dvec3 ring = glm::dvec3(14.3, 13.6, 9.4) + glm::dvec3(0, -8.2, 0);  // the tube's middle
    const std::pair<const char*, glm::dvec3> places[] = {
        {"inside an opaque voxel", ring + glm::dvec3(0.31, 0.2, -0.13)},
        {"on a voxel centre", glm::round(ring)},
        {"between voxels", glm::round(ring) + 0.5},
        {"1e-6 outside", ring - glm::dvec3(0, 4.1 + 1e-6, 0)},
        {"at the grid's corner", glm::dvec3(0)}};
    for (const auto& [name, eye] : places) {
        for (const WarpFamily warp : kWarps) {
            for (const double fov : {2.0, 150.0}) {
                Shot shot = everything();
                shot.settings.warp = warp;
                shot.settings.sheet_spacing = 1;
                shot.scene.materials[2].extinction = 20;
                shot.camera = look(*shot.volume, eye, {14, 20, 9}, fov);
                shot.width = shot.height = 12;
                expect_sound_slices(shot, fmt::format("{}, {}, fov {}", name, name_of(warp), fov));
            }
        }
    }
}

}  // namespace
}  // namespace edgesplat::test
