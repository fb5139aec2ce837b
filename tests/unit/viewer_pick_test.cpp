// Picking along rays, compared with surfaces in closed form.
#include "engine/viewer/pick.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iostream>
#include <string>

#include "engine/volume/analytic_volumes.h"
#include "engine/volume/pack_volume.h"
#include "tests/unit/refusal.h"
#include "tests/unit/viewer_random.h"
#include "tests/unit/viewer_volumes.h"

namespace edgesplat::viewer {
namespace {

using namespace viewer_test;

/// A solid ball of radius 15 mm in the middle.
Cavity ball() {
    Cavity cavity = hollow_ball();
    const glm::dvec3 c(23.3, 24.1, 23.7);
    cavity.name = "ball";
    cavity.room = [=](const glm::dvec3& x) { return glm::length(x - c) - 15; };
    cavity.inside = c;
    return cavity;
}

/// A half space of matter; the normal `away` points out of it.
const glm::dvec3 kAway = glm::normalize(glm::dvec3(0.3, -0.8, 0.5));
Cavity half_space(const glm::dvec3& away = kAway) {
    Cavity cavity = hollow_ball();
    cavity.name = "plane";
    cavity.inside = glm::dvec3(23.4, 24.2, 23.8);
    cavity.room = [=, at = cavity.inside](const glm::dvec3& x) { return glm::dot(x - at, away); };
    return cavity;
}

Cavity placed_askew(Cavity cavity, double blur) {
    cavity.axes = kTurned;
    cavity.origin = {100, -20, 7};
    cavity.spacing = {1, 1, 3};
    cavity.dims = {48, 48, 16};
    cavity.blur = blur;
    return cavity;
}

/// Errors of picks along random rays, mm, and how often the uncertainty covers them.
struct Accuracy {
    int count = 0, missed = 0, covered = 0;
    double mean = 0, worst = 0, mean_uncertainty = 0;
    double share() const { return static_cast<double>(covered) / count; }
};

constexpr int kRays = 1000;

enum class Kind { Float, Steps, Binary };

Accuracy accuracy(Cavity cavity, Kind kind = Kind::Float) {
    if (kind == Kind::Binary) cavity.blur = 0;
    auto volume = std::make_shared<Volume>(*sampled(cavity));
    if (kind == Kind::Steps)
        for (float& v : volume->values)
            v = std::round(v * 12) / 12;
    finish_volume(*volume);
    const Scene scene = solid_scene();
    Random random(5);
    Accuracy a;
    const glm::dvec3 size = glm::dvec3(cavity.dims) * cavity.spacing;
    while (a.count < kRays) {
        // From outside the matter to a place near its middle.
        const glm::dvec3 target = cavity.inside + random.direction() * random(0, 13);
        const glm::dvec3 eye = target + random.direction() * random(25, 80);
        if (cavity.room(eye) < 3) continue;
        const glm::dvec3 along = glm::normalize(target - eye);
        double low = 0;  // sphere tracing: `room` is a distance
        for (double room = cavity.room(eye); room > 1e-10 && low < 150; room = cavity.room(eye + low * along))
            low += room;
        if (low >= 150) continue;
        const glm::dvec3 place = eye + low * along;
        if (glm::any(glm::lessThan(place, 2.0 * cavity.spacing)) ||
            glm::any(glm::greaterThan(place, size - 3.0 * cavity.spacing)))
            continue;
        // At grazing incidence the position along the ray is ill defined: only rays up to 80 degrees.
        const double h = 1e-4, slope = (cavity.room(place + h * along) - cavity.room(place - h * along)) / (2 * h);
        if (slope > -std::cos(glm::radians(80.0))) continue;
        ++a.count;
        const auto found = pick(*volume, scene, Ray{cavity.to_world(eye), cavity.axes * along});
        if (!found) {
            ++a.missed;
            continue;
        }
        EXPECT_EQ(found->material, 1);
        EXPECT_NEAR(found->value, 0.5, 1e-12);
        EXPECT_NEAR(trilinear(*volume, found->world), 0.5, 1e-7);
        EXPECT_LT(glm::length(volume->geometry.to_world(found->voxel) - found->world), 1e-9);
        EXPECT_NEAR(glm::length(found->world - cavity.to_world(eye)), found->distance, 1e-9);
        EXPECT_NEAR(glm::length(found->normal), 1, 1e-12);
        EXPECT_LE(glm::dot(found->normal, cavity.axes * along), 0);
        const double error = std::abs(found->distance - low);
        a.covered += error <= found->uncertainty ? 1 : 0;
        a.mean += error / kRays;
        a.mean_uncertainty += found->uncertainty / kRays;
        a.worst = std::max(a.worst, error);
    }
    std::cout << cavity.name << ": error " << a.mean << " mm, at most " << a.worst << ", uncertainty "
              << a.mean_uncertainty << ", covered " << 100 * a.share() << " %, missed " << a.missed << '\n';
    return a;
}

TEST(ViewerPick, UncertaintyCoversSurfaceError) {
    for (const double blur : {0.3, 0.5, 0.7, 1.0})
        for (Cavity cavity :
             {ball(), half_space(), half_space({0, 1, 0}), half_space(glm::normalize(glm::dvec3(1, 1, 0))),
              half_space(glm::normalize(glm::dvec3(1, -1, 1.1)))}) {
            cavity.blur = blur;
            const Accuracy a = accuracy(cavity);
            EXPECT_LT(a.mean, blur < 0.5 ? 0.3 : 0.15) << cavity.name;
            EXPECT_LT(a.worst, blur < 0.5 ? 0.8 : 0.4) << cavity.name;
            EXPECT_GE(a.share(), 0.95) << cavity.name << ' ' << blur;
            EXPECT_LT(a.mean_uncertainty, 0.03 + 7 * a.mean) << cavity.name << ": the uncertainty is too large";
            EXPECT_EQ(a.missed, 0);
        }
}

TEST(ViewerPick, HandlesAnisotropicObliqueVolumes) {
    for (const Cavity& cavity : {placed_askew(ball(), 2), placed_askew(half_space(), 2)}) {
        const Accuracy a = accuracy(cavity);
        EXPECT_LT(a.mean, 0.15) << cavity.name;
        EXPECT_GE(a.share(), 0.95) << cavity.name;
        EXPECT_LT(a.mean_uncertainty, 0.5) << cavity.name << ": the uncertainty is too large";
    }
}

TEST(ViewerPick, UncertaintyGrowsWithCoarseValues) {
    for (const Cavity& cavity : {ball(), half_space()}) {
        const Accuracy steps = accuracy(cavity, Kind::Steps), binary = accuracy(cavity, Kind::Binary);
        EXPECT_GE(steps.share(), 0.95) << cavity.name;
        EXPECT_LT(steps.mean_uncertainty, 0.5);
        EXPECT_GE(binary.share(), 0.95) << cavity.name;
        EXPECT_LT(binary.mean_uncertainty, 2);
    }
}

Ray ray_at_ball(double offset = 0) {
    return {ball().inside + glm::dvec3(offset, -60, 0), {0, 1, 0}};
}

TEST(ViewerPick, NormalsPointOutOfTheSurface) {
    const Cavity cavity = placed_askew(ball(), 2);
    const auto volume = sampled(cavity);
    Random random(5);
    for (int i = 0; i < 200; ++i) {
        const glm::dvec3 out = random.direction();
        const Ray ray{cavity.to_world(cavity.inside + 40.0 * out), -(cavity.axes * out)};
        const auto found = pick(*volume, solid_scene(), ray);
        ASSERT_TRUE(found);
        EXPECT_GT(glm::dot(found->normal, cavity.axes * out), 0.99);
        EXPECT_NEAR(found->distance, 25, 0.3);
    }
}

TEST(ViewerPick, PicksThroughPixels) {
    const Cavity cavity = ball();
    const auto volume = sampled(cavity);
    const Camera camera{cavity.inside + glm::dvec3(0, -60, 0), {0, 1, 0}, {0, 0, 1}, 40};
    const glm::ivec2 size(300, 200);
    const auto middle = pick(*volume, solid_scene(), camera, size, {150, 100});
    ASSERT_TRUE(middle);
    EXPECT_NEAR(middle->distance, 45, 0.1);
    // +x is right, +z up; pixels are counted from the top left.
    const auto right = pick(*volume, solid_scene(), camera, size, {180.5, 90.5});
    ASSERT_TRUE(right);
    EXPECT_GT(right->world.x, cavity.inside.x + 2);
    EXPECT_GT(right->world.z, cavity.inside.z + 0.5);
    EXPECT_LT(glm::length(*project(camera, size, right->world) - glm::dvec2(180.5, 90.5)), 1e-9);
    EXPECT_FALSE(pick(*volume, solid_scene(), camera, size, {0.5, 0.5}));
    EXPECT_NE(refusal([&] {
                  pick(*volume, solid_scene(), camera, size, {1, 1}, 1);
              }).find("opacity"),
              std::string::npos);
    EXPECT_NE(refusal([&] { pick(*volume, solid_scene(), camera, {0, 3}, {1, 1}); }), "");
    EXPECT_NE(refusal([&] { pick(*volume, Scene{}, camera, size, {1, 1}); }), "");
    EXPECT_FALSE(pick(*volume, solid_scene(), camera, size, {NAN, 1}));
}

TEST(ViewerPick, MissReturnsNothing) {
    const auto volume = sampled(ball());
    EXPECT_FALSE(pick(*volume, solid_scene(), ray_at_ball(17)));
    EXPECT_FALSE(pick(*volume, solid_scene(), {{-10, -10, -10}, {-1, 0, 0}}));
    EXPECT_FALSE(pick(*volume, solid_scene(), {ball().inside + glm::dvec3(0, 20, 0), {0, 1, 0}}));
    EXPECT_FALSE(pick(*volume, solid_scene(0.001), ray_at_ball()));
}

TEST(ViewerPick, PicksFromInsideMatter) {
    const auto volume = sampled(ball());
    const Ray ray{ball().inside + glm::dvec3(0, -2, 0), {0, 1, 0}};
    const auto solid = pick(*volume, solid_scene(), ray);
    ASSERT_TRUE(solid);
    EXPECT_EQ(solid->distance, 0);
    EXPECT_EQ(solid->material, 1);
    const auto translucent = pick(*volume, solid_scene(0.1), ray);
    ASSERT_TRUE(translucent);
    EXPECT_NEAR(translucent->distance, std::log(2.0) / 0.1, 1e-6);
}

// 30 mm of extinction 0.1 per mm behind a known edge: half of the light remains 6.93 mm behind it.
TEST(ViewerPick, TranslucentMatterIsUncertain) {
    const auto volume = sampled(ball());
    const auto found = pick(*volume, solid_scene(0.1), ray_at_ball());
    ASSERT_TRUE(found);
    EXPECT_NEAR(found->distance, 45 + std::log(2.0) / 0.1, 0.05);
    EXPECT_NEAR(found->uncertainty, std::log(3.0) / 0.1, 1e-6);
    EXPECT_EQ(found->material, 1);
    EXPECT_NEAR(found->value, 1, 1e-3);
    const auto deeper = pick(*volume, solid_scene(0.1), ray_at_ball(), 0.9);
    ASSERT_TRUE(deeper);
    EXPECT_NEAR(deeper->distance, 45 + std::log(10.0) / 0.1, 0.05);
    // Opacity 3/4 is never reached: the uncertainty extends to the end of the matter.
    const auto thin = pick(*volume, solid_scene(0.03), ray_at_ball());
    ASSERT_TRUE(thin);
    EXPECT_NEAR(thin->uncertainty, 30 - std::log(4.0 / 3) / 0.03, 0.1);
}

// A translucent hull in front of a solid: the pick is the solid's contour unless the hull reaches the opacity alone.
TEST(ViewerPick, PicksBehindTranslucentHulls) {
    Cavity cavity = ball();
    cavity.blur = 2;
    const auto volume = sampled(cavity);
    Scene scene;
    scene.iso_values = {0.1, 0.9};
    scene.materials = {{}, {{}, 0.02}, {{}, 10}};
    const double hull = 2 * 2 * 1.2815515;  // mm between the two contours
    auto found = pick(*volume, scene, ray_at_ball());
    ASSERT_TRUE(found);
    EXPECT_EQ(found->material, 2);
    EXPECT_NEAR(found->value, 0.9, 1e-12);
    EXPECT_NEAR(found->distance, 45 + hull / 2, 0.1);
    EXPECT_LT(found->uncertainty, 0.3);
    scene.materials[1].extinction = 0.2;
    found = pick(*volume, scene, ray_at_ball());
    ASSERT_TRUE(found);
    EXPECT_EQ(found->material, 1);
    EXPECT_NEAR(found->distance, 45 - hull / 2 + std::log(2.0) / 0.2, 0.1);
}

TEST(ViewerPick, HandlesTransferFunctions) {
    Cavity cavity = half_space();
    cavity.blur = 0;
    auto volume = std::make_shared<Volume>(*sampled(cavity));
    for (std::size_t i = 0; i < volume->values.size(); ++i)
        volume->values[i] = static_cast<float>(i % 48);  // the value is x
    finish_volume(*volume);
    Scene scene;
    scene.iso_values = {};
    scene.materials = {{}};
    scene.transfer = {{10, {}, 0}, {20, {}, 0.4}, {30, {}, 0}};
    // tau at x: 0.02 (x - 10)^2.
    const auto found = pick(*volume, scene, {{-5, 20.3, 20.7}, {1, 0, 0}});
    ASSERT_TRUE(found);
    const auto place = [](double opacity) { return 10 + std::sqrt(-std::log(1 - opacity) / 0.02); };
    EXPECT_NEAR(found->world.x, place(0.5), 1e-6);
    EXPECT_NEAR(found->value, place(0.5), 1e-6);
    EXPECT_NEAR(found->uncertainty, place(0.75) - place(0.25), 1e-6);
}

TEST(ViewerPick, RespectsClipPlanes) {
    const Cavity cavity = ball();
    const auto volume = sampled(cavity);
    Scene scene = solid_scene();
    scene.effects.clip.keep = {{cavity.inside + glm::dvec3(0, -4, 0), {0, -2, 0}}};
    auto found = pick(*volume, scene, ray_at_ball());
    ASSERT_TRUE(found);
    EXPECT_NEAR(found->distance, 56, 1e-9);
    EXPECT_EQ(found->uncertainty, 0);
    EXPECT_LT(glm::length(found->normal - glm::dvec3(0, -1, 0)), 1e-9);
    scene.effects.clip = {};
    scene.effects.clip.remove = {{cavity.inside + glm::dvec3(0, 3, 0), {0, 1, 0}}};
    found = pick(*volume, scene, ray_at_ball());
    ASSERT_TRUE(found);
    EXPECT_NEAR(found->distance, 63, 1e-9);
    scene.effects.clip.keep = {{cavity.inside, {0, 1, 0}}};
    EXPECT_FALSE(pick(*volume, scene, ray_at_ball()));
}

TEST(ViewerPick, PicksSideOfVolume) {
    const Cavity cavity = half_space();
    const auto volume = sampled(cavity);
    // kAway.y < 0, so the side of high y is matter.
    const auto found = pick(*volume, solid_scene(), {{23, 100, 23}, {0, -1, 0}});
    ASSERT_TRUE(found);
    EXPECT_NEAR(found->world.y, 47.5, 1e-9);
    EXPECT_EQ(found->uncertainty, 0.5);
    EXPECT_EQ(found->normal, glm::dvec3(0, 1, 0));
}

TEST(ViewerPick, PackedVolumeGivesSameResult) {
    const Cavity cavity = ball();
    const auto volume = sampled(cavity);
    const auto file =
        std::filesystem::temp_directory_path() / ("edgesplat-viewer-pick-" + std::to_string(getpid()) + ".h5");
    pack_volume(*volume, file.string());
    const Volume packed = open_packed(file.string());
    Random random(5);
    for (int i = 0; i < 50; ++i) {
        const glm::dvec3 out = random.direction();
        const Ray ray{cavity.inside + 50.0 * out + random.direction() * 5.0, -out};
        const auto a = pick(*volume, solid_scene(), ray), b = pick(packed, solid_scene(), ray);
        ASSERT_EQ(a.has_value(), b.has_value());
        if (!a) continue;
        EXPECT_EQ(a->world, b->world);
        EXPECT_EQ(a->uncertainty, b->uncertainty);
    }
    EXPECT_EQ(interpolated(packed, {20.3, 11.2, 31.9}), interpolated(*volume, {20.3, 11.2, 31.9}));
    std::filesystem::remove(file);
}

TEST(ViewerScreen, MapsPixelsToRays) {
    const Camera camera{{1, 2, 3}, {0, 1, 0}, {0, 0, 1}, 90};
    const glm::ivec2 size(400, 200);
    EXPECT_LT(glm::length(pixel_ray(camera, size, {200, 100}).direction - glm::dvec3(0, 1, 0)), 1e-12);
    EXPECT_LT(glm::length(pixel_ray(camera, size, {400, 0}).direction - glm::normalize(glm::dvec3(2, 1, 1))), 1e-12);
    const auto corner = project(camera, size, glm::dvec3(1, 2, 3) + glm::dvec3(20, 10, 10));
    ASSERT_TRUE(corner);
    EXPECT_LT(glm::length(*corner - glm::dvec2(400, 0)), 1e-9);
    EXPECT_FALSE(project(camera, size, {1, 1, 3}));
    EXPECT_FALSE(project(camera, size, {5, 2, 3}));
    EXPECT_NEAR(pixel_size(camera, size, 10), 0.1, 1e-12);
}

/// A ray through several volumes picks the nearest surface, with the values of its volume.
TEST(ViewerPick, FindsTheNearestOfSeveralVolumes) {
    const Volume far = builtin_volume("builtin:sphere:32");
    auto near = std::make_shared<Volume>(builtin_volume("builtin:sphere:20"));
    const double radius = glm::length(near->geometry.center() - near->geometry.to_world(glm::dvec3(0)));
    near->geometry.origin += glm::dvec3(0, -200, 0) + far.geometry.center() - near->geometry.center();
    Scene scene;
    scene.iso_values = {0.5};
    scene.materials = {{}, {.extinction = 8}};
    scene.added = {
        {.volume = near, .iso_values = {0.4}, .materials = scene.materials, .transfer = {}, .label_colors = {}}};
    const Ray ray{far.geometry.center() - glm::dvec3(0, 1000, 0), {0, 1, 0}};
    const auto first = pick(far, scene, ray);
    ASSERT_TRUE(first);
    EXPECT_EQ(first->number, 1U);
    EXPECT_NEAR(first->value, 0.4, 1e-6);
    EXPECT_LT(glm::length(first->world - near->geometry.center()), radius);
    EXPECT_LT(glm::length(near->geometry.to_world(first->voxel) - first->world), 1e-9);
    EXPECT_EQ(&volume_of(far, scene, first->number), near.get());
    scene.added[0].materials[1].extinction = 0;
    const auto behind = pick(far, scene, ray);
    ASSERT_TRUE(behind);
    EXPECT_EQ(behind->number, 0U);
    EXPECT_NEAR(behind->value, 0.5, 1e-6);

    const auto there = values_at(far, scene, behind->world);
    ASSERT_EQ(there.size(), 1U);
    EXPECT_NEAR(there[0].value, 0.5, 1e-6);
    near->geometry.origin += glm::dvec3(0, 200, 0);
    const auto both = values_at(far, scene, far.geometry.center());
    ASSERT_EQ(both.size(), 2U);
    EXPECT_EQ(both[1].number, 1U);
    EXPECT_GT(both[1].value, 0.9);
    EXPECT_TRUE(values_at(far, scene, {1e6, 0, 0}).empty());
}

}  // namespace
}  // namespace edgesplat::viewer
