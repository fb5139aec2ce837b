// Built-in scenes, compared with finite differences and the properties of a distance; filters, compared with sums by
// hand.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <random>
#include <string>

#include "engine/error.h"
#include "engine/volume/analytic_volumes.h"
#include "engine/volume/filters.h"

namespace {

using namespace edgesplat;
using testing::HasSubstr;

std::vector<glm::dvec3> points(const AnalyticScene& scene, int count) {
    std::mt19937 random(7);
    std::vector<glm::dvec3> result;
    for (int i = 0; i < count; ++i) {
        glm::dvec3 p;
        for (int axis = 0; axis < 3; ++axis)
            p[axis] = (scene.dims[axis] - 1) * (static_cast<double>(random()) / 4294967296.0);
        result.push_back(p);
    }
    return result;
}

std::vector<AnalyticScene> smooth_scenes() {
    std::vector<AnalyticScene> scenes;
    for (const auto name : analytic_scene_names())
        if (name != "cube-hole") scenes.push_back(analytic_scene(name));
    scenes.push_back(cube_hole_scene(glm::ivec3(20), 12, 3.5, {}));
    scenes.push_back(slab_scene(glm::ivec3(32), {1, 2, 3}, {15, 15, 15}, 0.6));
    scenes.push_back(resized(analytic_scene("sphere"), {40, 50, 60}));
    return scenes;
}

TEST(AnalyticVolumes, GradientsAgreeWithDifferences) {
    for (const auto& scene : smooth_scenes()) {
        const double range = scene.name == "phantom" ? 2000 : 1;
        int checked = 0;
        for (const auto& p : points(scene, 4000)) {
            constexpr double h = 1e-4;
            const auto gradient = scene.gradient(p);
            glm::dvec3 difference;
            double bend = 0;  // large at creases of the distance, where there is no gradient
            for (int axis = 0; axis < 3; ++axis) {
                glm::dvec3 e(0);
                e[axis] = h;
                const double above = scene.value(p + e), here = scene.value(p), below = scene.value(p - e);
                difference[axis] = (above - below) / (2 * h);
                bend = std::max(bend, std::abs(above - 2 * here + below) / h);
            }
            if (bend > 2e-2 * range) continue;
            ASSERT_LT(glm::length(gradient - difference), 1e-4 * range)
                << scene.name << ' ' << p.x << ' ' << p.y << ' ' << p.z;
            ++checked;
        }
        EXPECT_GT(checked, 3500) << scene.name;
    }
}

TEST(AnalyticVolumes, DistancesHaveSlopeAtMostOne) {
    for (const auto& scene : smooth_scenes()) {
        if (!scene.signed_distance || scene.name == "gyroid") continue;  // a distance only near the surface
        const auto where = points(scene, 600);
        for (std::size_t i = 1; i < where.size(); ++i) {
            const double a = scene.signed_distance(where[i - 1]), b = scene.signed_distance(where[i]);
            ASSERT_LE(std::abs(a - b), glm::length(where[i] - where[i - 1]) + 1e-9) << scene.name;
            // No surface point is nearer than the distance: a step of 0.999 of it does not cross the surface.
            const auto near = where[i] + glm::normalize(where[i - 1] - where[i]) * std::abs(b) * 0.999;
            ASSERT_GE(scene.signed_distance(near) * (b < 0 ? -1 : 1), -1e-9) << scene.name;
        }
    }
}

TEST(AnalyticVolumes, EdgesLieAtTheIsoValue) {
    for (const auto& scene : smooth_scenes()) {
        if (!scene.signed_distance || scene.name == "plates" || scene.name == "slab") continue;
        for (const auto& p : points(scene, 500)) {
            const double d = scene.signed_distance(p), value = scene.value(p);
            if (std::abs(d) < 1e-6) continue;
            ASSERT_EQ(d<0, value> scene.iso_values[0]) << scene.name;
        }
    }
    const auto sphere = sphere_scene(glm::ivec3(32), {15, 15, 15}, 5);
    EXPECT_NEAR(sphere.value({20, 15, 15}), 0.5, 1e-12);
    EXPECT_NEAR(sphere.signed_distance({15, 23, 15}), 3, 1e-12);
}

/// The surface point that Newton steps along the gradient reach from p; nullopt if they do not converge.
std::optional<glm::dvec3> surface_near(const AnalyticScene& scene, glm::dvec3 p) {
    constexpr double h = 1e-5;
    for (int i = 0; i < 30; ++i) {
        const double d = scene.signed_distance(p);
        glm::dvec3 slope;
        for (int axis = 0; axis < 3; ++axis) {
            glm::dvec3 e(0);
            e[axis] = h;
            slope[axis] = (scene.signed_distance(p + e) - scene.signed_distance(p - e)) / (2 * h);
        }
        if (std::abs(d) < 1e-10) return p;
        p -= d * slope / std::max(glm::dot(slope, slope), 0.25);
    }
    return {};
}

TEST(AnalyticVolumes, DistancesHaveUnitSlopeAtSurface) {
    for (const auto& scene : smooth_scenes()) {
        if (!scene.signed_distance) continue;
        int reached = 0, smooth = 0;
        for (const auto& start : points(scene, 400)) {
            const auto p = surface_near(scene, start);
            if (!p) continue;
            ++reached;
            constexpr double h = 1e-4;
            glm::dvec3 slope;
            for (int axis = 0; axis < 3; ++axis) {
                glm::dvec3 e(0);
                e[axis] = h;
                slope[axis] = (scene.signed_distance(*p + e) - scene.signed_distance(*p - e)) / (2 * h);
            }
            // Nearly half of the points converge to the edges of a cube, where the gradient is undefined.
            if (std::abs(glm::length(slope) - 1) < 1e-3) ++smooth;
        }
        EXPECT_GT(reached, 200) << scene.name;
        EXPECT_GT(smooth, (scene.name == "box" || scene.name == "cube-hole" ? 0.5 : 0.8) * reached) << scene.name;
    }
}

TEST(AnalyticVolumes, DistanceReachesNearestSurfacePoint) {
    // A step of the distance along steepest descent meets the surface: the distance is not too small. That its slope is
    // at most 1 shows that it is not too large.
    for (const char* name : {"ellipsoid", "box", "rounded-box", "tilted-torus", "tube", "shell", "balls", "small-ball",
                             "vessels", "specks"}) {
        const auto scene = analytic_scene(name);
        int checked = 0;
        for (const auto& p : points(scene, 400)) {
            const double d = scene.signed_distance(p);
            constexpr double h = 1e-5;
            glm::dvec3 slope;
            for (int axis = 0; axis < 3; ++axis) {
                glm::dvec3 e(0);
                e[axis] = h;
                slope[axis] = (scene.signed_distance(p + e) - scene.signed_distance(p - e)) / (2 * h);
            }
            if (std::abs(glm::length(slope) - 1) > 1e-6) continue;  // two surface points are equally near
            ASSERT_NEAR(scene.signed_distance(p - d * slope), 0, 1e-4 * (1 + std::abs(d))) << name;
            ++checked;
        }
        EXPECT_GT(checked, 350) << name;
    }
}

TEST(AnalyticVolumes, BodiesHaveDocumentedPositions) {
    const auto distance = [](const char* name, const glm::dvec3& x) { return analytic_scene(name).signed_distance(x); };
    EXPECT_NEAR(distance("small-ball", {19.7, 19.4, 19.2}), -4, 1e-12);
    EXPECT_NEAR(distance("shell", glm::dvec3(19.6, 19.3, 19.4) + glm::dvec3(0, 14.3, 0)), -0.9, 1e-12);
    EXPECT_LT(distance("tube", {0, 0, 0}), 0) << "matter is outside the lumen";
    EXPECT_GT(distance("tube", {3, 19.3, 19.8}), 0);
    EXPECT_NEAR(distance("ellipsoid", {19.7, 19.4, 19.2}), -6.4, 1e-6) << "its shortest half axis";
    EXPECT_NEAR(distance("box", {19.6, 19.3, 19.4}), -7.3, 1e-12);
    const auto binary = builtin_volume("builtin:binary-ball");
    for (const float value : binary.values)
        ASSERT_TRUE(value == 0.0F || value == 1.0F);
    // Volumes of specks (60 balls) and vessels (five tori), by counting samples.
    const auto held = [](const char* name) {
        const auto scene = resized(analytic_scene(name), glm::ivec3(157));
        double count = 0;
        for (int z = 0; z < 157; ++z)
            for (int y = 0; y < 157; ++y)
                for (int x = 0; x < 157; ++x)
                    count += scene.signed_distance(glm::dvec3(x, y, z)) <= 0 ? 1 : 0;
        return count / 64;
    };
    constexpr double kPi = 3.14159265358979;
    double balls = 0, rings = 0;
    for (int i = 0; i < 60; ++i)
        balls += 4 * kPi / 3 * std::pow(0.8 + 0.9 * i / 59, 3);
    for (const double radius : {0.9, 1.15, 1.4, 1.65, 1.9})
        rings += 2 * kPi * kPi * 12.2 * radius * radius;
    EXPECT_NEAR(held("specks") / balls, 1, 0.01);
    EXPECT_NEAR(held("vessels") / rings, 1, 0.01);
}

TEST(AnalyticVolumes, NoiseIsRelativeToStep) {
    for (const std::string name : {"sphere", "phantom", "gyroid:24"}) {
        const auto clean = builtin_volume("builtin:" + name + ":noise=0");
        const auto noisy = builtin_volume("builtin:" + name + ":noise=0.02");
        const double rise = name == "phantom" ? 1900 : 1;
        double sum = 0, squares = 0;
        for (std::size_t i = 0; i < clean.values.size(); ++i) {
            const double d = (static_cast<double>(noisy.values[i]) - static_cast<double>(clean.values[i])) / rise;
            sum += d;
            squares += d * d;
        }
        const auto count = static_cast<double>(clean.values.size());
        EXPECT_NEAR(sum / count, 0, 1e-3) << name;
        EXPECT_NEAR(std::sqrt(squares / count), 0.02, 4e-4) << name;
        EXPECT_EQ(noisy.checksum, builtin_volume("builtin:" + name + ":noise=0.02").checksum);
        EXPECT_NE(noisy.checksum, builtin_volume("builtin:" + name + ":noise=0.02:seed=2").checksum);
    }
    EXPECT_EQ(builtin_volume("builtin:sphere:noise=0.1:24").geometry.dims, glm::ivec3(24));
    EXPECT_EQ(builtin_scene("builtin:phantom").noise, 12);
    const auto refusal = [](const char* path) -> std::string {
        try {
            builtin_scene(path);
        } catch (const Error& error) {
            return error.what();
        }
        return "";
    };
    EXPECT_THAT(refusal("builtin:box:noise=-1"), HasSubstr("builtin:box:noise=-1: noise: '-1': expected a share"));
    EXPECT_THAT(refusal("builtin:box:noise=nan"), HasSubstr("expected a share"));
    EXPECT_THAT(refusal("builtin:box:20:noise=0.1x"), HasSubstr("'0.1x'"));
    EXPECT_THAT(refusal("builtin:box:seed=1.5"), HasSubstr("seed: '1.5': expected a whole number"));
    EXPECT_THAT(refusal("builtin:box:speed=1"), HasSubstr("'speed=1' is neither"));
    EXPECT_THAT(refusal("builtin:bax:noise=0.1"), HasSubstr("no built-in volume 'bax'"));
}

TEST(AnalyticVolumes, CubeHoleMatchesPaper) {
    const auto volume = builtin_volume("builtin:cube-hole");
    double inside = 0;
    for (const float value : volume.values) {
        ASSERT_TRUE(value == 0.0F || value == 1.0F);
        inside += static_cast<double>(value);
    }
    EXPECT_NEAR(inside, 12 * (144 - 3.14159 * 3.5 * 3.5), 80);  // 12^3 minus the hole, at voxel centres
    EXPECT_EQ(volume.at(4, 4, 10), 1.0F);
    EXPECT_EQ(volume.at(3, 10, 10), 0.0F);
    EXPECT_EQ(volume.at(9, 10, 10), 0.0F);
    const auto scene = analytic_scene("cube-hole");
    EXPECT_NEAR(scene.signed_distance({9.5, 9.5, 17.5}), std::hypot(2.0, 3.5), 1e-12);
    EXPECT_NEAR(scene.signed_distance({9.5, 9.5, 9.5}), 3.5, 1e-12);
}

TEST(AnalyticVolumes, ThinSlabsKeepTheirMass) {
    const auto slab = slab_scene(glm::ivec3(32), {1, 1, 0.3}, {15, 15, 15}, 0.6);
    const auto normal = glm::normalize(glm::dvec3(1, 1, 0.3));
    double sum = 0;
    for (double t = -6; t < 6; t += 0.01)
        sum += 0.01 * slab.value(glm::dvec3(15) + t * normal);
    EXPECT_NEAR(sum, 0.6, 1e-6);
}

TEST(AnalyticVolumes, ParseNamesAndDims) {
    EXPECT_EQ(builtin_volume("builtin:phantom").checksum, builtin_volume("builtin:phantom").checksum);
    EXPECT_EQ(builtin_volume("builtin:sphere:24x20x16").geometry.dims, glm::ivec3(24, 20, 16));
    EXPECT_EQ(builtin_volume("builtin:orbital:32").geometry.dims, glm::ivec3(32));
    for (const char* wrong : {"builtin:none", "builtin:sphere:", "builtin:sphere:8x8", "builtin:sphere:1",
                              "builtin:sphere:8x8x8x8", "builtin:sphere:8:", "builtin:sphere:8x8x99999999999"})
        EXPECT_THROW(builtin_volume(wrong), Error) << wrong;
    EXPECT_THROW(sphere_scene(glm::ivec3(8), {4, 4, 4}, -1), Error);
    EXPECT_THROW(plane_scene(glm::ivec3(8), {0, 0, 0}, {4, 4, 4}), Error);
    EXPECT_THROW(torus_scene(glm::ivec3(8), {4, 4, 4}, 2, 3), Error);
}

TEST(FinishVolume, EstimatesNoiseAndNoticesMasks) {
    for (const double sigma : {0.0, 0.02, 5.0}) {
        Volume volume;
        volume.geometry.dims = {40, 38, 36};
        std::mt19937 random(4);
        std::normal_distribution<double> noise(0, sigma > 0 ? sigma : 1);
        for (int z = 0; z < 36; ++z)
            for (int y = 0; y < 38; ++y)
                for (int x = 0; x < 40; ++x) {
                    // A ramp with a step in it: neither is noise.
                    const double smooth = 0.01 * x + (y > 19 ? 1 : 0);
                    volume.values.push_back(static_cast<float>(smooth + (sigma > 0 ? noise(random) : 0)));
                }
        finish_volume(volume);
        EXPECT_NEAR(volume.noise, sigma, 0.1 * sigma + 1e-6) << sigma;
        EXPECT_FALSE(volume.two_values);
    }
    Volume mask = sample(builtin_scene("builtin:binary-ball:24"));
    EXPECT_TRUE(mask.two_values);
    mask.values[5] = 0.5F;
    finish_volume(mask);
    EXPECT_FALSE(mask.two_values);
}

TEST(FinishVolume, ReplacesAndCountsNonFiniteSamples) {
    Volume volume;
    volume.name = "test";
    volume.geometry.dims = {2, 2, 1};
    volume.values = {NAN, 3, -INFINITY, 2};
    finish_volume(volume);
    EXPECT_EQ(volume.non_finite_count, 2U);
    EXPECT_THAT(volume.values, testing::ElementsAre(2, 3, 2, 2));
    volume.values.assign(4, NAN);
    finish_volume(volume);
    EXPECT_EQ(volume.non_finite_count, 4U);
    EXPECT_EQ(volume.max_value, 0.0F);
    volume.values.resize(3);
    EXPECT_THROW(finish_volume(volume), Error);
    volume.values.resize(4);
    volume.geometry.index_to_world_axes[1] = volume.geometry.index_to_world_axes[0];
    EXPECT_THROW(finish_volume(volume), Error);
}

TEST(Filters, ComputeBoxThresholdAndScaling) {
    const auto cube = builtin_volume("builtin:cube-hole");
    const auto box = box_filter(cube);
    EXPECT_NEAR(box.at(5, 5, 5), 1, 1e-6);
    EXPECT_NEAR(box.at(4, 6, 6), 18.0 / 27, 1e-6);
    EXPECT_NEAR(box.at(4, 4, 4), 8.0 / 27, 1e-6);
    EXPECT_EQ(threshold(box, 0.6).at(4, 6, 6), 1.0F);
    EXPECT_EQ(threshold(box, 0.7).at(4, 6, 6), 0.0F);
    Volume volume;
    volume.geometry.dims = {3, 1, 1};
    volume.values = {-10, 0, 30};
    finish_volume(volume);
    EXPECT_THAT(scaled_field(volume), testing::ElementsAre(0, 0.25F, 1));
    EXPECT_EQ(scaled_value(volume, 70), 2);
    volume.values.assign(3, 5);
    finish_volume(volume);
    EXPECT_THAT(scaled_field(volume), testing::Each(0));
    EXPECT_TRUE(suggest_iso_values(volume).empty());
}

namespace {

double spline_at(const std::vector<float>& coefficients, const glm::ivec3& dims, const glm::dvec3& p) {
    const auto x = spline_taps(p.x, dims.x), y = spline_taps(p.y, dims.y), z = spline_taps(p.z, dims.z);
    const glm::dvec3 beyond = p - glm::clamp(p, glm::dvec3(0), glm::dvec3(dims - 1));
    double sum = 0;
    for (std::size_t k = 0; k < 4; ++k)
        for (std::size_t j = 0; j < 4; ++j)
            for (std::size_t i = 0; i < 4; ++i) {
                const int at = (z.places[k] * dims.y + y.places[j]) * dims.x + x.places[i];
                const double wx = x.weights[i], wy = y.weights[j], wz = z.weights[k];
                const glm::dvec3 slope(x.slopes[i] * wy * wz, wx * y.slopes[j] * wz, wx * wy * z.slopes[k]);
                sum += (wx * wy * wz + glm::dot(slope, beyond)) *
                       static_cast<double>(coefficients[static_cast<std::size_t>(at)]);
            }
    return sum;
}

}  // namespace

TEST(Filters, BsplineCoefficientsInterpolate) {
    for (const char* name : {"builtin:sphere:24x20x16", "builtin:sphere:7x3x2", "builtin:sphere:5x2x4"}) {
        const auto volume = builtin_volume(name);
        const auto& dims = volume.geometry.dims;
        const auto c = bspline_coefficients(volume.values, dims);
        ASSERT_EQ(c.size(), volume.values.size());
        for (int z = 0; z < dims.z; ++z)
            for (int y = 0; y < dims.y; ++y)
                for (int x = 0; x < dims.x; ++x)
                    ASSERT_NEAR(spline_at(c, dims, {x, y, z}), volume.at(x, y, z), 1e-5) << name;
    }
    EXPECT_EQ(bspline_coefficients({1, 2, 3}, {3, 1, 1}).size(), 3U);
    EXPECT_THROW(bspline_coefficients({1, 2}, {3, 1, 1}), Error);
}

TEST(Filters, SplineExtrapolatesLinearly) {
    const glm::ivec3 dims(6, 5, 2);
    const auto plane = [](const glm::dvec3& p) { return 0.3 + 0.1 * p.x - 0.04 * p.y + 0.2 * p.z; };
    std::vector<float> samples;
    for (int z = 0; z < dims.z; ++z)
        for (int y = 0; y < dims.y; ++y)
            for (int x = 0; x < dims.x; ++x)
                samples.push_back(static_cast<float>(plane({x, y, z})));
    const auto c = bspline_coefficients(samples, dims);
    for (const glm::dvec3 p : {glm::dvec3(-0.5, 2.3, 1.5), {5.5, 4.5, -0.5}, {0, 0.2, 0}, {4.9, 4, 1}, {2.5, -2, 3}})
        EXPECT_NEAR(spline_at(c, dims, p), plane(p), 1e-6);
    // Slopes are the derivatives of the weights.
    for (const double place : {0.3, 1.7, 4.2})
        for (std::size_t k = 0; k < 4; ++k) {
            const double h = 1e-5;
            const double slope =
                (spline_taps(place + h, dims.x).weights[k] - spline_taps(place - h, dims.x).weights[k]) / (2 * h);
            EXPECT_NEAR(spline_taps(place, dims.x).slopes[k], slope, 1e-8) << place;
        }
}

TEST(Filters, ComputeHistogramAndIsoValues) {
    const auto sphere = builtin_volume("builtin:sphere");
    const auto bins = histogram(sphere, 16);
    std::size_t sum = 0;
    for (const auto count : bins.counts)
        sum += count;
    EXPECT_EQ(sum, sphere.values.size());
    EXPECT_NEAR(suggest_iso_values(sphere).at(0).value, 0.5, 0.05);
    EXPECT_NEAR(suggest_iso_values(builtin_volume("builtin:cube-hole")).at(0).value, 0.5, 0.01);
    const auto head = suggest_iso_values(builtin_volume("builtin:phantom"));
    ASSERT_GE(head.size(), 2U);
    EXPECT_NEAR(head[0].value, -450, 150);
    EXPECT_LE(head[1].strength, 1);
    EXPECT_THROW(histogram(sphere, 0), Error);
}

}  // namespace
