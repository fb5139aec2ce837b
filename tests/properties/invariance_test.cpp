// Changes that must not affect the picture, and changes with a known effect.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/ext/matrix_transform.hpp>
#include <numbers>

#include "tests/properties/scenes.h"

namespace edgesplat::test {
namespace {

// --- A uniform slab absorbs according to the closed form --------------------------------------------------------

/// Alpha in the middle of a uniform box, seen along `direction` (index space) from far away, minus the closed form.
double slab_error(const glm::dmat3& axes, double sheet_spacing, const glm::dvec3& direction, EdgeEstimator edges) {
    constexpr int kSize = 16;
    Shot shot;
    shot.volume = sampled(
        glm::ivec3(kSize), [](const glm::dvec3&) { return 1.0; }, axes);
    const glm::dvec3 way = axes * direction;  // one voxel-sized step of the ray, in world space
    const double length =
        glm::length(way) / std::max({std::abs(direction.x), std::abs(direction.y), std::abs(direction.z)}) * kSize;
    const double extinction = 1 / length;
    shot.scene = two_tone(0, extinction);
    shot.settings.edges = edges;
    shot.settings.sheet_spacing = sheet_spacing;
    shot.settings.saturation = 1;
    shot.camera = look(*shot.volume, glm::dvec3(7.5) - 1000.0 * direction, glm::dvec3(7.5), 0.1);
    shot.width = shot.height = 24;
    const Image color = render(shot).color;
    double worst = 0;
    for (int y = 8; y < 16; ++y)
        for (int x = 8; x < 16; ++x)
            worst = std::max(worst, std::abs(static_cast<double>(color.at(x, y, 3)) - (1 - std::exp(-1.0))));
    return worst;
}

constexpr double kSlabTolerance = 4e-4;  // the kernel's own ripple (7e-5 in 3-D), 10 nodes and single precision

TEST(Slab, AbsorbsByTheClosedFormAtEverySheetSpacing) {
    for (const double spacing : {0.25, 0.5, 1.0, 2.0, 4.0}) {
        for (const auto edges : {EdgeEstimator::Off, EdgeEstimator::March}) {
            EXPECT_LE(slab_error(glm::dmat3(1), spacing, {0, 1, 0}, edges), kSlabTolerance) << spacing;
            EXPECT_LE(slab_error(glm::dmat3(1), spacing, {0.2, 1, -0.1}, edges), kSlabTolerance) << spacing;
        }
    }
}

TEST(Slab, AbsorbsByTheClosedFormOnAnisotropicAndObliqueGrids) {
    const glm::dmat3 thick(glm::dvec3(0.4, 0, 0), glm::dvec3(0, 0.7, 0), glm::dvec3(0, 0, 3));
    const glm::dmat3 oblique(glm::dvec3(0.9, 0.2, 0.1), glm::dvec3(0.2, -1.1, 0.15), glm::dvec3(0.1, 0.3, 1.7));
    for (const double spacing : {0.25, 1.0, 4.0}) {
        for (const glm::dvec3& direction : {glm::dvec3(1, 0, 0), glm::dvec3(0, 1, 0), glm::dvec3(0, 0, 1)}) {
            EXPECT_LE(slab_error(thick, spacing, direction, EdgeEstimator::March), kSlabTolerance) << spacing;
            EXPECT_LE(slab_error(oblique, spacing, direction, EdgeEstimator::March), kSlabTolerance) << spacing;
        }
    }
}

// --- Settings without effect, or with a bounded one -------------------------------------------------------------

TEST(Settings, EdgesOffIsIsotropicBitForBit) {
    Shot shot = torus_shot();
    shot.settings.edges = EdgeEstimator::Off;
    const Image off = render(shot).color;
    shot.settings.edges = EdgeEstimator::March;
    shot.settings.footprints = FootprintMode::Isotropic;
    EXPECT_EQ(off.pixels, render(shot).color.pixels);
}

TEST(Settings, SaturationChangesNoMoreThanItsThreshold) {
    Shot shot = torus_shot();
    shot.scene.materials[2].extinction = 6;
    shot.settings.sheet_spacing = 0.25;
    shot.settings.saturation = 1;
    const Image all = render(shot).color;
    for (const double saturation : {0.9, 0.99, 0.999}) {
        shot.settings.saturation = saturation;
        EXPECT_LE(compare_images(all, render(shot).color).max, 1 - saturation + 1e-5) << saturation;
    }
}

TEST(Settings, CullingBuriedVoxelsChangesLittle) {
    Shot shot = torus_shot();
    const Image culled = render(shot).color;
    shot.settings.cull_buried = false;
    EXPECT_LE(compare_images(culled, render(shot).color).max, 1.0 / 256);
}

// --- Position of the volume -------------------------------------------------------------------------------------

void expect_alike(const Image& a, const Image& b, const char* what) {
    const ImageDifference difference = compare_images(a, b, 2e-3);
    EXPECT_LE(difference.share, 0.01) << what << ", largest " << difference.max;
    EXPECT_GE(difference.psnr, 55) << what;
}

TEST(Place, DoesNotMatterIfRotatedAndShiftedTogether) {
    Shot shot = torus_shot();
    shot.scene.lights = {directional_light({0.4, -1, 0.6})};
    const glm::dmat3 rotation(glm::rotate(glm::dmat4(1), 1.1, glm::normalize(glm::dvec3(1, -2, 0.7))));
    const RenderResult still = render(shot, {.tau = true, .depth = true});
    const RenderResult turned = render(moved(shot, rotation, {300, -120, 45}), {.tau = true, .depth = true});
    expect_alike(still.color, turned.color, "colour");
    expect_alike(*still.tau, *turned.tau, "tau");
    for (std::size_t i = 0; i < still.depth->pixels.size(); ++i) {
        if (still.color.pixels[4 * i + 3] > 0.1F) {
            ASSERT_NEAR(still.depth->pixels[i], turned.depth->pixels[i], 0.02) << i;
        }
    }
}

TEST(Place, MirroredTogetherMirrorsThePicture) {
    Shot shot = torus_shot();
    shot.scene.lights = {directional_light({0.4, -1, 0.6})};
    const Image still = render(shot).color;
    const Image mirrored = render(moved(shot, glm::dmat3(-1, 0, 0, 0, 1, 0, 0, 0, 1), {7, 0, 0})).color;
    expect_alike(still, flipped(mirrored), "mirrored in x");
    // The grid's axis and the samples reversed: the same object.
    const auto& v = *shot.volume;
    const auto reversed = sampled(v.geometry.dims, [&](const glm::dvec3& x) {
        return static_cast<double>(
            v.at(static_cast<int>(x.x), v.geometry.dims.y - 1 - static_cast<int>(x.y), static_cast<int>(x.z)));
    });
    shot.volume = placed(reversed, glm::dmat3(1, 0, 0, 0, -1, 0, 0, 0, 1), {0, v.geometry.dims.y - 1, 0});
    expect_alike(still, render(shot).color, "axis y and samples reversed");
}

TEST(Place, DoesNotMatterIfScaledTogether) {
    Shot shot = torus_shot();
    const Image still = render(shot).color;
    for (const double scale : {1e-3, 1e3}) {
        Shot other = moved(shot, glm::dmat3(scale), {0, 0, 0});
        for (Material& material : other.scene.materials)
            material.extinction /= scale;
        expect_alike(still, render(other).color, "scaled");
    }
}

}  // namespace
}  // namespace edgesplat::test
