// Situations in which surfaces of real volumes showed artefacts, as scenes with exact pictures: never worse than cubic
// rays.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <string>

#include "tests/properties/exact_scenes.h"

namespace edgesplat::test {
namespace {

using glm::dvec3;

/// A solid by its signed distance, voxels, negative inside; blurred like a scan.
AnalyticScene solid(const glm::ivec3& dims, const std::function<double(const dvec3&)>& distance,
                    const dvec3& spacing = dvec3(1)) {
    AnalyticScene scene;
    scene.dims = dims;
    scene.spacing = spacing;
    scene.iso_values = {0.5};
    scene.value = [distance](const dvec3& x) { return 0.5 * std::erfc(distance(x) / (0.7 * std::sqrt(2.0))); };
    scene.gradient = [value = scene.value](const dvec3& x) {
        constexpr double step = 1e-4;
        dvec3 slope;
        for (int axis = 0; axis < 3; ++axis) {
            dvec3 to(0);
            to[axis] = step;
            slope[axis] = (value(x + to) - value(x - to)) / (2 * step);
        }
        return slope;
    };
    return scene;
}

/// A hexagonal nut with a round hole.
AnalyticScene nut() {
    return solid({52, 32, 46}, [](const dvec3& x) {
        const dvec3 p = x - dvec3(25.4, 15.7, 22.6);
        const double hexagon =
            std::max({std::abs(p.z), std::abs(0.866 * p.x + 0.5 * p.z), std::abs(0.866 * p.x - 0.5 * p.z)});
        return std::max({hexagon - 18.3, std::abs(p.y) - 9.4, 8.6 - std::hypot(p.x, p.z)});
    });
}

/// Ridges, in slices that are eight times as thick as pixels are wide.
AnalyticScene ridges() {
    const auto height = [](const dvec3& x) {
        return 9.5 + 2.2 * std::cos(0.3 * x.x + 0.1 * x.y) + 1.1 * std::sin(0.21 * x.y);
    };
    return solid({48, 40, 18},
                 [height](const dvec3& x) {
                     const double slope =
                         std::hypot(0.66 * std::sin(0.3 * x.x + 0.1 * x.y),
                                    0.22 * std::sin(0.3 * x.x + 0.1 * x.y) - 0.23 * std::cos(0.21 * x.y));
                     return (x.z - height(x)) / std::hypot(1.0, slope);
                 },
                 {0.5, 0.5, 4});
}

/// Noise reaches a low iso-value in single voxels.
AnalyticScene speckle() {
    AnalyticScene scene = builtin_scene("builtin:ellipsoid:32:noise=0.04");
    scene.iso_values = {0.14};
    return scene;
}

/// A block with passages two to three voxels wide, on voxels twice as high.
AnalyticScene passages() {
    return solid({36, 32, 26},
                 [](const dvec3& x) {
                     const double block =
                         std::max({std::abs(x.x - 17.5) - 13, std::abs(x.y - 15.5) - 11, std::abs(x.z - 12.5) - 8});
                     double way = 1e9;
                     for (int k = -1; k <= 1; ++k)
                         way = std::min(way, std::hypot(x.x - 17.5 - 7 * k - 1.5 * std::sin(0.3 * x.y), x.z - 12.3) -
                                                 1.1 - 0.2 * k);
                     return std::max(block, -way);
                 },
                 {1, 1, 2});
}

/// Rods one voxel thick.
AnalyticScene rods() {
    return solid({30, 30, 30}, [](const dvec3& x) {
        const dvec3 p = x - dvec3(14.6, 14.3, 14.8);
        const auto rod = [&](const dvec3& axis) { return glm::length(glm::cross(p, glm::normalize(axis))) - 0.5; };
        const double thin = std::min({rod({1, 0.3, 0.1}), rod({0.1, 1, -0.4}), rod({-0.3, 0.2, 1})});
        return std::max(thin, glm::length(p) - 12);
    });
}

/// A wave that the volume's border cuts.
AnalyticScene wave() {
    return solid({32, 30, 28}, [](const dvec3& x) {
        return (x.z - 12 - 4 * std::sin(0.45 * x.x + 0.2 * x.y)) /
               std::hypot(1.0, 1.97 * std::cos(0.45 * x.x + 0.2 * x.y));
    });
}

struct Situation {
    const char* name;
    AnalyticScene (*scene)();
    dvec3 near;  ///< an eye close by, index space
};

class Situations : public testing::TestWithParam<Situation> {};

TEST_P(Situations, AreNotWorseThanCubicRays) {
    const AnalyticScene scene = GetParam().scene();
    const Exact whole = exact_scene(scene);
    Shot close = whole.shot;
    close.camera = look(*close.volume, GetParam().near, dvec3(scene.dims - 1) / 2.0, 50);
    for (const Exact& exact : {whole, exact_shot(scene, close)}) {
        const Shot& shot = exact.shot;
        const auto rays = [&](RaycastFilter filter) {
            return decibels(
                test_renderer()
                    .raycast(shot.scene, shot.camera, shot.settings, {.filter = filter}, shot.width, shot.height)
                    .color,
                exact.truth);
        };
        const double surfaces = decibels(render(shot).color, exact.truth), cubic = rays(RaycastFilter::Cubic);
        std::printf("%-9s surfaces %.1f dB, trilinear rays %.1f, cubic %.1f\n", GetParam().name, surfaces,
                    rays(RaycastFilter::Trilinear), cubic);
        EXPECT_GE(surfaces, cubic - 0.3);
    }
}

INSTANTIATE_TEST_SUITE_P(All, Situations,
                         testing::Values(Situation{"nut", nut, {25, -3, 8}}, Situation{"ridges", ridges, {20, 0, 16}},
                                         Situation{"speckle", speckle, {16, 0, 8}},
                                         Situation{"passages", passages, {17, -6, 13}},
                                         Situation{"rods", rods, {8, 6, 9}}, Situation{"wave", wave, {16, 8, 23}}),
                         [](const auto& test) { return std::string(test.param.name); });

}  // namespace
}  // namespace edgesplat::test
