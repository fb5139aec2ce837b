// The renderer `truth` on analytic scenes, compared with closed forms and plain small steps.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "engine/reference/truth.h"
#include "engine/scene/views.h"

namespace edgesplat::reference {
namespace {

Scene look_of(const AnalyticScene& scene, double extinction, bool lit = false) {
    Scene look;
    look.iso_values = scene.iso_values;
    look.materials = {{}};
    for (std::size_t i = 0; i < scene.iso_values.size(); ++i)
        look.materials.push_back({{1, 0.5, 0.25}, extinction * (i == 0 ? 1 : 20)});
    if (!lit) look.lights.clear();
    return look;
}

/// Looks along `direction` at the middle of the grid from `distance` voxels away. Spacing 1.
Camera looking_at(const AnalyticScene& scene, const glm::dvec3& direction, double distance, double fov_y) {
    Camera camera;
    camera.direction = glm::normalize(direction);
    camera.eye = (glm::dvec3(scene.dims) - 1.0) / 2.0 - distance * camera.direction;
    camera.fov_y = fov_y;
    return camera;
}

/// A grid's geometry without its samples.
VolumeGeometry geometry_of(const AnalyticScene& scene) {
    VolumeGeometry geometry;
    geometry.dims = scene.dims;
    for (int axis = 0; axis < 3; ++axis)
        geometry.index_to_world_axes[axis][axis] = scene.spacing[axis];
    return geometry;
}

DirectResult seen(const AnalyticScene& scene, const Scene& look, const Camera& camera, int width, int height,
                  double tolerance = 1e-5) {
    DirectOptions options;
    options.tolerance = tolerance;
    return truth(scene, geometry_of(scene), look, camera, width, height, options);
}

/// Length of the part of a ray inside a ball.
double chord(const glm::dvec3& eye, const glm::dvec3& u, const glm::dvec3& center, double radius) {
    const glm::dvec3 v = center - eye;
    const double rho2 = glm::dot(v, v) - glm::dot(v, u) * glm::dot(v, u);
    return 2 * std::sqrt(std::max(radius * radius - rho2, 0.0));
}

TEST(Truth, SeveralRaysPerPixelAverageLargerPicture) {
    const AnalyticScene scene = analytic_scene("sphere");
    const Camera camera = looking_at(scene, {1, 2, -1}, 60, 40);
    Scene look = look_of(scene, 0.5, true);
    const Image large = seen(scene, look, camera, 36, 36).image;
    look.effects.samples = 3;
    const Image mean = seen(scene, look, camera, 12, 12).image;
    for (int y = 0; y < 12; ++y) {
        for (int x = 0; x < 12; ++x) {
            for (int c = 0; c < 4; ++c) {
                double sum = 0;
                for (int k = 0; k < 9; ++k)
                    sum += static_cast<double>(large.at(3 * x + k % 3, 3 * y + k / 3, c)) / 9;
                EXPECT_NEAR(static_cast<double>(mean.at(x, y, c)), sum, 1e-4) << x << ' ' << y;
            }
        }
    }
}

TEST(Truth, SphereMatchesChordLengths) {
    const AnalyticScene scene = analytic_scene("sphere");
    const Camera camera = looking_at(scene, {1, 2, -1}, 100, 30);
    const View view(camera, geometry_of(scene), 96, 96);
    for (const double extinction : {0.02, 8.0}) {
        const DirectResult result = seen(scene, look_of(scene, extinction), camera, 96, 96);
        EXPECT_LE(result.error_estimate, 1e-5);
        for (int y = 0; y < 96; ++y) {
            for (int x = 0; x < 96; ++x) {
                const double length = chord(view.eye_index, view.ray(x, y), {31.7, 31.4, 31.2}, 20);
                const double expected = -std::expm1(-extinction * length);
                EXPECT_NEAR(static_cast<double>(result.image.at(x, y, 3)), expected, 1e-5) << x << ',' << y;
                EXPECT_NEAR(static_cast<double>(result.image.at(x, y, 1)), 0.5 * expected, 1e-5);
            }
        }
    }
}

TEST(Truth, SphereSilhouetteIsExact) {
    // 16 pixels across one edge of the ball, each divided into 1000.
    const AnalyticScene scene = analytic_scene("sphere");
    constexpr int kPixels = 16;
    constexpr int kParts = 1000;
    const glm::dvec3 center(31.7, 31.4, 31.2);
    Camera camera;
    camera.eye = center - glm::dvec3(0, 100, 0);
    const double edge = std::asin(20 / 100.0);
    camera.direction = {std::sin(edge), std::cos(edge), 0};
    const double tan_half_x = std::tan(glm::radians(2.0));
    camera.fov_y = 2 * glm::degrees(std::atan(tan_half_x / (kPixels * kParts)));
    const Image image = seen(scene, look_of(scene, 1e7), camera, kPixels * kParts, 1).image;
    int covered = 0;
    for (int x = 0; x < image.width; ++x)
        covered += image.at(x, 0, 3) > 0.5F ? 1 : 0;
    EXPECT_NEAR(covered, kPixels * kParts / 2, 1);
}

TEST(Truth, LightUsesExactNormal) {
    const AnalyticScene scene = analytic_scene("sphere");
    Scene look = look_of(scene, 1e6, true);
    look.lights = {directional_light({0.6, -0.8, 0})};
    const Camera camera = looking_at(scene, {0, 1, 0}, 100, 30);
    const View view(camera, geometry_of(scene), 64, 64);
    const Image image = seen(scene, look, camera, 64, 64).image;
    const glm::dvec3 center(31.7, 31.4, 31.2);
    for (int y = 0; y < 64; ++y) {
        for (int x = 0; x < 64; ++x) {
            const glm::dvec3 u = view.ray(x, y);
            const double length = chord(view.eye_index, u, center, 20);
            if (!(length > 0.01)) continue;
            const glm::dvec3 hit = view.eye_index + (glm::dot(center - view.eye_index, u) - length / 2) * u;
            const double facing = glm::dot((hit - center) / 20.0, look.lights.front().direction);
            EXPECT_NEAR(static_cast<double>(image.at(x, y, 0)), 0.15 + 0.85 * std::max(facing, 0.0), 2e-5);
        }
    }
}

TEST(Truth, CubeWithHoleMatchesClosedForm) {
    const AnalyticScene scene = analytic_scene("cube-hole");
    constexpr double kExtinction = 0.1;
    const Scene look = look_of(scene, kExtinction);
    // Nearly parallel rays along y and z; the cube's middle is the grid's, 9.5.
    for (const glm::dvec3& direction : {glm::dvec3(0, 1, 0), glm::dvec3(0, 0, 1)}) {
        const Camera camera = looking_at(scene, direction, 1e6, glm::degrees(20e-6));
        const View view(camera, geometry_of(scene), 80, 80);
        const Image image = seen(scene, look, camera, 80, 80).image;
        for (int y = 0; y < 80; ++y) {
            for (int x = 0; x < 80; ++x) {
                const glm::dvec3 u = view.ray(x, y);
                const glm::dvec3 p = view.eye_index + 1e6 * u - 9.5;
                const double a = std::abs(p.x);
                const double b = std::abs(direction.y > 0 ? p.z : p.y);
                const double hole = direction.y > 0 ? 2 * std::sqrt(std::max(3.5 * 3.5 - a * a, 0.0))
                                                    : (a * a + b * b < 3.5 * 3.5 ? 12 : 0);
                if (std::abs(a - 6) < 1e-3 || std::abs(b - 6) < 1e-3 || std::abs(std::hypot(a, b) - 3.5) < 1e-3)
                    continue;
                const double length = a < 6 && b < 6 ? 12 - hole : 0;
                EXPECT_NEAR(static_cast<double>(image.at(x, y, 3)), -std::expm1(-kExtinction * length), 1e-3)
                    << a << ',' << b;
            }
        }
    }
}

TEST(Truth, EverySceneEqualsLimitOfSmallSteps) {
    constexpr int kSize = 10;
    for (const std::string_view name : analytic_scene_names()) {
        const AnalyticScene scene = analytic_scene(name);
        Scene look = look_of(scene, 0.02);
        const VolumeGeometry geometry = geometry_of(scene);
        Camera camera = looking_at(scene, {1, 2, -1}, 110, 35);
        camera.eye *= scene.spacing;
        const View view(camera, geometry, kSize, kSize);
        const DirectResult result = seen(scene, look, camera, kSize, kSize);
        EXPECT_LE(result.error_estimate, 1e-5);
        for (int y = 0; y < kSize; ++y) {
            for (int x = 0; x < kSize; ++x) {
                const glm::dvec3 u = view.ray(x, y);
                constexpr double kSmall = 0.004;
                double tau = 0;
                for (double t = 40; t < 190; t += kSmall) {
                    const glm::dvec3 p = view.eye_index + t * u;
                    if (glm::any(glm::lessThan(p, glm::dvec3(-0.5))) ||
                        glm::any(glm::greaterThan(p, glm::dvec3(scene.dims) - 0.5)))
                        continue;
                    const double value = scene.value(p);
                    std::size_t m = 0;
                    while (m < look.iso_values.size() && look.iso_values[m] <= value)
                        ++m;
                    tau += kSmall * look.materials[m].extinction * scene.spacing.x;
                }
                EXPECT_NEAR(static_cast<double>(result.image.at(x, y, 3)), -std::expm1(-tau), 4e-3)
                    << name << ' ' << x << ',' << y;
            }
        }
    }
}

TEST(Truth, IntegratesTransferFunctionOverValues) {
    // Values rise linearly along z and extinction is a tent over them, so tau of a ray is the tent's area. The colours
    // of its two sides appear in the order in which the ray meets them.
    AnalyticScene scene = analytic_scene("plane");
    scene.value = [](const glm::dvec3& x) { return x.z / 10; };
    scene.gradient = [](const glm::dvec3&) { return glm::dvec3(0, 0, 0.1); };
    scene.signed_distance = {};
    Scene look;
    look.lights.clear();
    look.materials = {{}};
    look.transfer = {{1, {1, 0, 0}, 0}, {2, {1, 0, 0}, 0.3}, {2.5, {0, 1, 0}, 0}};
    Camera camera;
    camera.direction = {0.1, 0.2, 1};
    camera.up = {0, 1, 0};
    camera.eye = (glm::dvec3(scene.dims) - 1.0) / 2.0 - 100.0 * camera.direction;
    camera.fov_y = 10;
    const View view(camera, geometry_of(scene), 32, 32);
    const Image image = seen(scene, look, camera, 32, 32, 1e-6).image;
    for (const glm::ivec2 p : {glm::ivec2(16, 16), glm::ivec2(3, 20), glm::ivec2(25, 9)}) {
        const double per_value = 10 / std::abs(view.ray(p.x, p.y).z);
        const double first = 0.15 * per_value, second = 0.075 * per_value;
        EXPECT_NEAR(static_cast<double>(image.at(p.x, p.y, 3)), -std::expm1(-first - second), 1e-5);
        // Small steps through the second side, whose colour changes from red to green.
        double red = -std::expm1(-first), transmittance = std::exp(-first);
        constexpr int kSteps = 100000;
        for (int i = 0; i < kSteps; ++i) {
            const double t = (i + 0.5) / kSteps, tau = 0.3 * (1 - t) * 0.5 * per_value / kSteps;
            red += transmittance * tau * (1 - t);
            transmittance *= std::exp(-tau);
        }
        EXPECT_NEAR(static_cast<double>(image.at(p.x, p.y, 0)), red, 1e-5);
    }
    // Without iso-values there are no edges; light uses only the normal of the volume's border.
    look.lights = {directional_light({0, 0, -1})};
    look.lights[0].intensity = 1;
    look.ambient = 0;
    look.transfer = {{1, {1, 1, 1}, 0}, {1.5, {1, 1, 1}, 50}};
    camera.direction = {0, 0, 1};
    camera.eye = (glm::dvec3(scene.dims) - 1.0) / 2.0 - glm::dvec3(0, 0, 100);
    EXPECT_NEAR(static_cast<double>(seen(scene, look, camera, 1, 1).image.at(0, 0, 1)), 1, 1e-4);
}

TEST(Truth, TighterTolerancesAgreeUnderLight) {
    for (const char* name : {"cube-hole", "orbital", "torus"}) {
        const AnalyticScene scene = analytic_scene(name);
        const Scene look = look_of(scene, 0.1, true);
        const Camera camera = looking_at(scene, {1, 2, -1}, 100, 30);
        const DirectResult coarse = seen(scene, look, camera, 32, 32, 1e-3);
        const DirectResult fine = seen(scene, look, camera, 32, 32, 1e-6);
        EXPECT_LE(coarse.error_estimate, 1e-3);
        for (std::size_t i = 0; i < fine.image.pixels.size(); ++i)
            EXPECT_NEAR(coarse.image.pixels[i], fine.image.pixels[i], 1e-3F) << name;
    }
}

TEST(Truth, IsFiniteFromInsideAndRefusesOtherGrids) {
    const AnalyticScene scene = analytic_scene("sphere");
    Camera camera;
    camera.eye = {31.7, 31.4, 31.2};  // the centre: all surface points are equally near
    camera.fov_y = 120;
    for (const float v : seen(scene, look_of(scene, 0.1, true), camera, 16, 16).image.pixels)
        ASSERT_TRUE(std::isfinite(v));
    VolumeGeometry other = geometry_of(scene);
    other.dims.x = 10;
    EXPECT_THROW(truth(scene, other, look_of(scene, 1), camera, 4, 4), Error);
    DirectOptions options;
    options.progress = [](double) { return false; };
    EXPECT_THROW(truth(scene, geometry_of(scene), look_of(scene, 1), camera, 4, 4, options), Cancelled);
}

}  // namespace
}  // namespace edgesplat::reference
