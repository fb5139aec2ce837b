// Built-in scenes against finite differences and the defining properties of a distance; filters against hand sums.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>

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

TEST(AnalyticVolumes, DistancesAreDistances) {
    for (const auto& scene : smooth_scenes()) {
        if (!scene.signed_distance) continue;
        const auto where = points(scene, 600);
        for (std::size_t i = 1; i < where.size(); ++i) {
            const double a = scene.signed_distance(where[i - 1]), b = scene.signed_distance(where[i]);
            ASSERT_LE(std::abs(a - b), glm::length(where[i] - where[i - 1]) + 1e-9) << scene.name;
            // There is a surface point within the distance, and none nearer: walk there along the gradient.
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

TEST(AnalyticVolumes, CubeHoleIsThePapersCube) {
    const auto volume = builtin_volume("builtin:cube-hole");
    double inside = 0;
    for (const float value : volume.values) {
        ASSERT_TRUE(value == 0.0F || value == 1.0F);
        inside += static_cast<double>(value);
    }
    EXPECT_NEAR(inside, 12 * (144 - 3.14159 * 3.5 * 3.5), 80);  // 12^3 less the hole, at voxel centres
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

TEST(AnalyticVolumes, NamesDimsAndNoise) {
    EXPECT_EQ(builtin_volume("builtin:phantom").checksum, builtin_volume("builtin:phantom").checksum);
    EXPECT_EQ(builtin_volume("builtin:sphere:24x20x16").geometry.dims, glm::ivec3(24, 20, 16));
    EXPECT_EQ(builtin_volume("builtin:orbital:32").geometry.dims, glm::ivec3(32));
    for (const char* wrong : {"builtin:none", "builtin:sphere:", "builtin:sphere:8x8", "builtin:sphere:1",
                              "builtin:sphere:8x8x8x8", "builtin:sphere:8x8x99999999999"})
        EXPECT_THROW(builtin_volume(wrong), Error) << wrong;
    EXPECT_THROW(sphere_scene(glm::ivec3(8), {4, 4, 4}, -1), Error);
    EXPECT_THROW(plane_scene(glm::ivec3(8), {0, 0, 0}, {4, 4, 4}), Error);
    EXPECT_THROW(torus_scene(glm::ivec3(8), {4, 4, 4}, 2, 3), Error);
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

TEST(Filters, BoxThresholdAndScaling) {
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

TEST(Filters, BsplineCoefficientsInterpolate) {
    const auto volume = builtin_volume("builtin:sphere:24x20x16");
    const auto& dims = volume.geometry.dims;
    const auto c = bspline_coefficients(volume.values, dims);
    ASSERT_EQ(c.size(), volume.values.size());
    const auto mirrored = [](int i, int n) { return i < 0 ? -i : i >= n ? 2 * (n - 1) - i : i; };
    const double weight[] = {1.0 / 6, 4.0 / 6, 1.0 / 6};
    for (int z = 0; z < dims.z; ++z)
        for (int y = 0; y < dims.y; ++y)
            for (int x = 0; x < dims.x; ++x) {
                double sum = 0;
                for (int k = 0; k < 3; ++k)
                    for (int j = 0; j < 3; ++j)
                        for (int i = 0; i < 3; ++i) {
                            const int at =
                                (mirrored(z + k - 1, dims.z) * dims.y + mirrored(y + j - 1, dims.y)) * dims.x +
                                mirrored(x + i - 1, dims.x);
                            sum += weight[i] * weight[j] * weight[k] *
                                   static_cast<double>(c[static_cast<std::size_t>(at)]);
                        }
                ASSERT_NEAR(sum, volume.at(x, y, z), 1e-5);
            }
    EXPECT_EQ(bspline_coefficients({1, 2, 3}, {3, 1, 1}).size(), 3U);
    EXPECT_THROW(bspline_coefficients({1, 2}, {3, 1, 1}), Error);
}

TEST(Filters, HistogramAndIsoValues) {
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
