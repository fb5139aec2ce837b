// The ray caster against closed forms, against itself without its optimizations, and against splatting.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>

#include "engine/error.h"
#include "engine/reference/interpolated_scene.h"
#include "tests/properties/exact_scenes.h"

namespace edgesplat::test {
namespace {

constexpr RaycastFilter kCubic = RaycastFilter::Cubic;
constexpr std::array kFilters{RaycastFilter::Trilinear, kCubic};

/// The ray-cast version of a shot.
RenderResult cast(const Shot& shot, const RaycastSettings& how = {}) {
    Shot least = shot;  // makes render() set this volume in the renderer
    least.width = least.height = 1;
    render(least);
    return test_renderer().raycast(shot.scene, shot.camera, shot.settings, how, shot.width, shot.height);
}

/// A pixel's ray: eye and unit direction in index space, millimetres per voxel along it.
struct PixelRay {
    glm::dvec3 eye, u;
    double mm;
};
PixelRay ray_of(const Shot& shot, int x, int y) {
    const CameraFrame frame = camera_frame(shot.camera);
    const double sx = (2 * (x + 0.5) / shot.width - 1) * frame.tan_half_y * shot.width / shot.height;
    const double sy = (1 - 2 * (y + 0.5) / shot.height) * frame.tan_half_y;
    const auto& geometry = shot.volume->geometry;
    const glm::dvec3 world = frame.forward + sx * frame.right + sy * frame.up;
    const glm::dvec3 u = glm::normalize(glm::inverse(geometry.index_to_world_axes) * world);
    return {geometry.to_index(frame.eye), u, glm::length(geometry.index_to_world_axes * u)};
}

/// Values that fall linearly on both sides of the plane z = 10.3, and reach 0.5 at a distance of 5.2 voxels.
Shot wedge_shot(double extinction, const glm::dmat3& axes = glm::dmat3(1)) {
    Shot shot;
    shot.volume = sampled(
        {24, 22, 21}, [](const glm::dvec3& x) { return 5.7 - std::abs(x.z - 10.3); }, axes);
    shot.scene = two_tone(0, extinction);
    shot.camera = look(*shot.volume, {11, 9, -30}, {11.5, 10.5, 10}, 14, {0, 1, 0});
    return shot;
}

TEST(Raycast, GivesTheExactOpacityOfASlabAtEveryStep) {
    const glm::dmat3 oblique(glm::dvec3(0.9, 0.2, 0.1), glm::dvec3(0.2, -1.1, 0.15), glm::dvec3(0.1, 0.3, 1.7));
    for (const glm::dmat3& axes : {glm::dmat3(1), oblique}) {
        for (const double step : {0.1, 0.5, 1.3}) {
            const Shot shot = wedge_shot(0.08, axes);
            const Image color = cast(shot, {.step = step}).color;
            for (const glm::ivec2& p : {glm::ivec2(32, 32), glm::ivec2(20, 40), glm::ivec2(44, 25)}) {
                const PixelRay ray = ray_of(shot, p.x, p.y);
                const double expected = -std::expm1(-0.08 * 10.4 / std::abs(ray.u.z) * ray.mm);
                EXPECT_NEAR(static_cast<double>(color.at(p.x, p.y, 3)), expected, 2e-4) << "step " << step;
            }
        }
    }
}

TEST(Raycast, IgnoresMatterBehindTheEye) {
    Shot shot = wedge_shot(0.2);
    shot.camera.eye = shot.volume->geometry.to_world({11.2, 10.1, 9.4});
    const Image color = cast(shot).color;
    const PixelRay ray = ray_of(shot, 30, 31);
    const double expected = -std::expm1(-0.2 * (10.3 + 5.2 - 9.4) / ray.u.z);
    EXPECT_NEAR(static_cast<double>(color.at(30, 31, 3)), expected, 2e-4);
}

TEST(Raycast, PlacesAndLightsASphereCorrectly) {
    const glm::dvec3 center(15.7, 15.2, 14.9);
    constexpr double kRadius = 9;
    Shot shot;
    shot.volume = std::make_shared<const Volume>(sample(sphere_scene(glm::ivec3(32), center, kRadius)));
    shot.scene.iso_values = {0.5};
    shot.scene.materials = {{}, {{1, 1, 1}, 8}};
    shot.camera = look(*shot.volume, {14, -60, 20}, center, 22);
    shot.width = shot.height = 96;
    const Image color = cast(shot).color;
    double squares = 0;
    int hits = 0;
    for (int y = 0; y < shot.height; ++y) {
        for (int x = 0; x < shot.width; ++x) {
            const PixelRay ray = ray_of(shot, x, y);
            const glm::dvec3 to_center = center - ray.eye;
            const double along = glm::dot(to_center, ray.u);
            const double aside = std::sqrt(glm::dot(to_center, to_center) - along * along);
            const double alpha = static_cast<double>(color.at(x, y, 3));
            if (aside > kRadius + 0.05) {
                EXPECT_EQ(alpha, 0) << x << ' ' << y;
            }
            if (aside > kRadius - 0.15) continue;
            EXPECT_GT(alpha, 0.99) << x << ' ' << y;
            const double cosine = std::sqrt(1 - aside * aside / (kRadius * kRadius));
            const double error = static_cast<double>(color.at(x, y, 0)) / alpha - (0.15 + 0.85 * cosine);
            EXPECT_LT(std::abs(error), 0.06) << x << ' ' << y;
            squares += error * error;
            ++hits;
        }
    }
    EXPECT_GT(hits, 1500);
    EXPECT_LT(std::sqrt(squares / hits), 0.03) << "central differences have an error of 2.7 degrees rms";
}

TEST(Raycast, SkipsEmptySpaceWithoutAChange) {
    Shot shot = torus_shot();
    shot.width = 90;
    const Camera inside = look(*shot.volume, {14.2, 13.5, 9.5}, {4, 13, 9}, 100);
    for (const Camera& camera : {shot.camera, inside}) {
        shot.camera = camera;
        for (const RaycastFilter filter : kFilters)
            EXPECT_EQ(cast(shot, {.filter = filter}).color.pixels,
                      cast(shot, {.filter = filter, .skip_empty = false}).color.pixels);
    }
}

TEST(Raycast, SkipsNoBrickInWhichTheSplineExceedsItsSamples) {
    Shot shot;
    unsigned state = 7;
    shot.volume = sampled({33, 30, 29}, [&](const glm::dvec3&) {
        state = state * 1664525U + 1013904223U;
        return (state >> 8U) / 16777216.0;
    });
    // One sample in a hundred lies above the iso-value, so that many bricks contain none.
    shot.scene = two_tone(0, 0.5);
    shot.scene.iso_values = {0.99};
    shot.camera = look(*shot.volume, {15, -60, 40}, {16, 15, 14}, 30);
    const Image leapt = cast(shot, {.filter = kCubic}).color;
    EXPECT_EQ(leapt.pixels, cast(shot, {.filter = kCubic, .skip_empty = false}).color.pixels);
    EXPECT_NE(leapt.pixels, cast(shot).color.pixels);
}

/// Compares a picture with rays through the same field in double precision and without steps.
class RaycastInDouble : public testing::TestWithParam<RaycastFilter> {
  protected:
    /// One pixel in a hundred is ignored: its ray grazes the surface, and matter shorter than a step may be missed.
    static void expect_near(const Shot& shot, double largest, double step = 0.5) {
        const RaycastSettings how{.step = step, .filter = GetParam()};
        reference::DirectOptions options;
        options.tolerance = 1e-5;
        const Image expected =
            reference::truth(reference::interpolated_scene(*shot.volume, how.filter, shot.scene), shot.volume->geometry,
                             shot.scene, shot.camera, shot.width, shot.height, options)
                .image;
        const Image color = cast(shot, how).color;
        std::vector<double> errors;
        for (std::size_t i = 0; i < color.pixels.size(); i += 4) {
            double worst = 0;
            for (std::size_t c = 0; c < 4; ++c)
                worst = std::max(worst, std::abs(static_cast<double>(color.pixels[i + c] - expected.pixels[i + c])));
            errors.push_back(worst);
        }
        std::ranges::sort(errors, std::greater());
        EXPECT_LE(errors[errors.size() / 100], largest);
    }
};

TEST_P(RaycastInDouble, MatchesLengthsThroughMatter) {
    Shot shot = torus_shot();
    shot.scene.lights.clear();
    shot.scene.materials[2].extinction = 0.08;
    // Two crossings with an error of 1e-4 voxel; trilinear interpolation has kinks, and half as many steps.
    expect_near(shot, GetParam() == kCubic ? 2 * 1e-4 * 0.08 : 3e-3);
}

TEST_P(RaycastInDouble, MatchesSurfacesAndTheirLight) {
    Shot shot = torus_shot();
    shot.scene.iso_values = {0.5};
    shot.scene.materials = {{}, {{1, 0.85, 0.7}, 500}};
    expect_near(shot, 1e-3);
}

/// Translucent layers of two colours around a torus, with a solid core.
std::vector<TransferPoint> veils() {
    return {{0.1, {0.2, 0.5, 1}, 0},     {0.2, {0.2, 0.5, 1}, 0.25}, {0.3, {0.9, 0.4, 0.1}, 0.05},
            {0.6, {0.9, 0.4, 0.1}, 0.1}, {0.75, {1, 0.9, 0.8}, 0.3}, {0.9, {1, 0.9, 0.8}, 4}};
}

TEST_P(RaycastInDouble, MatchesTransferFunctions) {
    Shot shot = torus_shot();
    shot.scene.iso_values.clear();
    shot.scene.materials = {{}};
    shot.scene.transfer = veils();
    // Between its samples, a ray assumes linear values and constant light; shorter steps show that this is the only
    // error.
    expect_near(shot, 0.02);
    expect_near(shot, 0.01, 0.1);
    shot.scene.lights.clear();
    expect_near(shot, 0.02);
    expect_near(shot, 2e-3, 0.1);
    // A step between two samples: within a thousandth of the range from transparent to solid.
    shot.scene.transfer = {{0.4999, {1, 0.5, 0.25}, 0}, {0.5001, {1, 0.5, 0.25}, 20}};
    expect_near(shot, 5e-3, 0.05);
}

INSTANTIATE_TEST_SUITE_P(Filters, RaycastInDouble, testing::ValuesIn(kFilters),
                         [](const auto& test) { return test.param == kCubic ? "cubic" : "trilinear"; });

/// Scenes that the grid barely resolves, where rays through the spline must be closer to the truth.
TEST(Raycast, IsCloserToTheTruthWithTheSpline) {
    struct Gain {
        const char* scene;
        double decibels;  ///< minimum, over trilinear interpolation
    };
    for (const auto& [name, least] :
         {Gain{"sphere", 6}, Gain{"torus", 3}, Gain{"tilted-torus", 3}, Gain{"ellipsoid", 4}, Gain{"small-ball", 4},
          Gain{"rounded-box", 4}, Gain{"box", 2}, Gain{"shell", 1.5}, Gain{"balls", 2}, Gain{"gyroid", 1},
          Gain{"vessels", 4}, Gain{"specks", 5}}) {
        const Exact exact = exact_scene(name);
        const double cubic = decibels(cast(exact.shot, {.filter = kCubic}).color, exact.truth);
        const double trilinear = decibels(cast(exact.shot).color, exact.truth);
        std::printf("%s: cubic %.1f dB, trilinear %.1f\n", name, cubic, trilinear);
        EXPECT_GE(cubic - trilinear, least) << name;
    }
}

TEST(Raycast, AppliesChangedMaterials) {
    Shot shot = torus_shot();
    const Image before = cast(shot).color;
    std::swap(shot.scene.materials[0], shot.scene.materials[1]);
    const Image changed = cast(shot).color;
    EXPECT_EQ(changed.pixels, cast(shot, {.skip_empty = false}).color.pixels);
    std::swap(shot.scene.materials[0], shot.scene.materials[1]);
    EXPECT_EQ(cast(shot).color.pixels, before.pixels);
}

TEST(Raycast, AppliesChangedTransferFunctions) {
    Shot shot = torus_shot();
    const Image materials = cast(shot).color;
    shot.scene.transfer = veils();
    for (const RaycastFilter filter : kFilters) {
        shot.scene.transfer = veils();
        const Image before = cast(shot, {.filter = filter}).color;
        EXPECT_EQ(before.pixels, cast(shot, {.filter = filter, .skip_empty = false}).color.pixels);
        shot.scene.transfer.erase(shot.scene.transfer.begin(), shot.scene.transfer.begin() + 4);
        const Image changed = cast(shot, {.filter = filter}).color;
        EXPECT_NE(changed.pixels, before.pixels);
        EXPECT_EQ(changed.pixels, cast(shot, {.filter = filter, .skip_empty = false}).color.pixels);
    }
    shot.scene.transfer.clear();
    EXPECT_EQ(cast(shot).color.pixels, materials.pixels);
}

TEST(Raycast, ExtendsATransferFunctionByItsEnds) {
    Shot shot = wedge_shot(0);
    const PixelRay ray = ray_of(shot, 32, 32);
    // The whole volume, from border to border.
    const double way = 21 / std::abs(ray.u.z) * ray.mm;
    for (const double value : {-100.0, 0.0, 2.0, 100.0}) {
        shot.scene.iso_values.clear();
        shot.scene.materials = {{}};
        shot.scene.transfer = {{value, {1, 1, 1}, 0.02}};
        EXPECT_NEAR(static_cast<double>(cast(shot).color.at(32, 32, 3)), -std::expm1(-0.02 * way), 2e-4) << value;
    }
    // Extinction is linear in values that rise to 5.7 and fall again; the samples beside the maximum are 5.4 and 5.
    shot.scene.transfer = {{0, {1, 1, 1}, 0}, {5.7, {1, 1, 1}, 0.1}};
    const double tau = 0.1 / 5.7 * (5.7 * 5.7 - (0.3 * 5.55 + 0.7 * 5.35 - 5.2)) / std::abs(ray.u.z) * ray.mm;
    EXPECT_NEAR(static_cast<double>(cast(shot, {.step = 0.1}).color.at(32, 32, 3)), -std::expm1(-tau), 1e-3);
}

TEST(Raycast, AppliesAChangedFilter) {
    const Shot shot = torus_shot();
    const Image trilinear = cast(shot).color, cubic = cast(shot, {.filter = kCubic}).color;
    EXPECT_NE(cubic.pixels, trilinear.pixels);
    EXPECT_EQ(cast(shot).color.pixels, trilinear.pixels);
    EXPECT_EQ(cast(shot, {.filter = kCubic}).color.pixels, cubic.pixels);
}

TEST(Raycast, LooksLikeSplatting) {
    const Shot shot = torus_shot();
    const Image splatted = render(shot).color;
    EXPECT_GT(compare_images(cast(shot).color, splatted).psnr, 24);
}

TEST(Raycast, DrawsSmallAndFlatVolumes) {
    for (const glm::ivec3& dims : {glm::ivec3(1), glm::ivec3(2), glm::ivec3(1, 9, 7), glm::ivec3(9, 1, 7),
                                   glm::ivec3(9, 7, 1), glm::ivec3(1, 1, 9)}) {
        for (const bool constant : {false, true}) {
            for (const RaycastFilter filter : kFilters) {
                Shot shot;
                shot.volume = sampled(dims, [&](const glm::dvec3& x) { return constant ? 1 : x.x + x.y + x.z + 1; });
                shot.scene = two_tone(0, 3);
                shot.scene.lights = {Light{}};
                const glm::dvec3 middle = glm::dvec3(dims - 1) / 2.0;
                for (const glm::dvec3& eye : {middle - glm::dvec3(9, 21, -13), middle - glm::dvec3(0, 20, 0), middle}) {
                    shot.camera = look(*shot.volume, eye, middle + glm::dvec3(0, 0.1, 0), 30);
                    const Image color = cast(shot, {.filter = filter}).color;
                    EXPECT_TRUE(within(color, 0, 1.0001F)) << fmt::format("{} x {} x {}", dims.x, dims.y, dims.z);
                    EXPECT_GT(color.at(32, 32, 3), 0.7F) << fmt::format("{} x {} x {}", dims.x, dims.y, dims.z);
                }
            }
        }
    }
}

TEST(Raycast, DrawsFromFarEyesAndAtWideAngles) {
    Shot shot = torus_shot();
    const glm::dvec3 target(14.3, 13.6, 9.4), way = glm::normalize(glm::dvec3(0.2, 1, -0.8));
    const auto seen_from = [&](double distance) {
        shot.camera = look(*shot.volume, target - distance * way, target, glm::degrees(2 * std::atan(16 / distance)));
        return cast(shot).color;
    };
    const Image far = seen_from(1e5);
    EXPECT_TRUE(within(far, 0, 1.0001F));
    EXPECT_GE(compare_images(seen_from(1e4), far).psnr, 35) << "both are nearly parallel projections";
    for (const RaycastFilter filter : kFilters) {
        shot.camera = look(*shot.volume, {14, 5.5, 9}, target, 170);
        EXPECT_TRUE(within(cast(shot, {.filter = filter}).color, 0, 1.0001F));
        shot.camera.direction = -shot.camera.direction;
        EXPECT_TRUE(within(cast(shot, {.filter = filter}).color, 0, 1.0001F));
    }
}

TEST(Raycast, ReportsItsPassAndRefusesInvalidSteps) {
    Shot shot = torus_shot();
    shot.scene.background = {0.25, 0.5, 0.75};
    shot.camera.direction = -shot.camera.direction;
    const RenderResult away = cast(shot);
    EXPECT_EQ(away.stats.passes.back().name, "raycast");
    EXPECT_FLOAT_EQ(away.color.at(5, 7, 1), 0.5F);
    EXPECT_EQ(away.color.at(5, 7, 3), 0);
    for (const double step : {0.0, -1.0, 5.0, std::numeric_limits<double>::quiet_NaN()})
        EXPECT_THROW(cast(shot, {.step = step}), Error) << step;
}

}  // namespace
}  // namespace edgesplat::test
