// Light, silhouettes, fog and transfer functions against closed forms.
#include <gtest/gtest.h>

#include <cstdio>
#include <functional>

#include "engine/error.h"
#include "engine/reference/3_select_footprints.h"
#include "engine/reference/truth.h"
#include "tests/properties/scenes.h"

namespace edgesplat::test {
namespace {

constexpr double kBallRadius = 13;
const glm::dvec3 kBallCentre(19.6, 19.3, 19.4);

/// An opaque white ball_shot, seen from far away.
Shot ball_shot() {
    Shot shot;
    shot.volume = std::make_shared<const Volume>(sample(sphere_scene({40, 40, 40}, kBallCentre, kBallRadius)));
    shot.scene.iso_values = {0.5};
    shot.scene.materials = {{}, {{1, 1, 1}, 6}};
    shot.camera = look(*shot.volume, {60, -180, 90}, kBallCentre, 8);
    shot.width = shot.height = 80;
    return shot;
}

/// Largest difference of channel `c` to `expected` (a function of normal and direction to the eye), over the pixels
/// that see the ball_shot within `rim` of its radius.
double worst_on_ball(const Shot& shot, const Image& picture, double rim,
                     const std::function<double(const glm::dvec3& n, const glm::dvec3& v)>& expected, int c = 0) {
    const reference::View view(shot.camera, shot.volume->geometry, shot.width, shot.height);
    double worst = 0;
    int seen = 0;
    for (int y = 0; y < shot.height; ++y) {
        for (int x = 0; x < shot.width; ++x) {
            const glm::dvec3 u = view.ray(x, y), o = view.eye_index - kBallCentre;
            const double b = glm::dot(o, u), miss2 = glm::dot(o, o) - b * b;
            if (!(miss2 < rim * rim * kBallRadius * kBallRadius)) continue;
            const glm::dvec3 n = (o + (-b - std::sqrt(kBallRadius * kBallRadius - miss2)) * u) / kBallRadius;
            worst = std::max(worst, std::abs(static_cast<double>(picture.at(x, y, c)) - expected(n, -u)));
            ++seen;
        }
    }
    EXPECT_GT(seen, 500);
    return worst;
}

TEST(Lambert, MatchesABallUnderADirectionalLight) {
    Shot shot = ball_shot();
    shot.scene.ambient = 0.1;
    shot.scene.lights = {directional_light({0.5, -1, 0.8})};
    shot.scene.lights[0].intensity = 0.9;
    const glm::dvec3 l = glm::normalize(glm::dvec3(0.5, -1, 0.8));
    const auto lambert = [&](const glm::dvec3& n, const glm::dvec3&) {
        return 0.1 + 0.9 * std::max(glm::dot(n, l), 0.0);
    };
    const double worst = worst_on_ball(shot, render(shot).color, 0.85, lambert);
    std::printf("Lambert: worst %.4f\n", worst);
    EXPECT_LE(worst, 0.03);
    // A distant point light is the same light.
    shot.scene.lights[0].kind = Light::Kind::Point;
    shot.scene.lights[0].position = kBallCentre + 1e7 * l;
    EXPECT_LE(worst_on_ball(shot, render(shot).color, 0.85, lambert), 0.03);
}

TEST(Lambert, MatchesABallUnderANearPointLight) {
    Shot shot = ball_shot();
    shot.scene.ambient = 0;
    Light light;
    light.kind = Light::Kind::Point;
    light.position = kBallCentre + glm::dvec3(10, -25, 12);
    light.color = {0.5, 1, 0.25};
    light.intensity = 1;
    shot.scene.lights = {light};
    const Image picture = render(shot).color;
    const auto facing = [&](const glm::dvec3& n, const glm::dvec3&) {
        return std::max(glm::dot(n, glm::normalize(light.position - kBallCentre - kBallRadius * n)), 0.0);
    };
    const double worst = worst_on_ball(shot, picture, 0.85, facing, 1);
    std::printf("point light: worst %.4f\n", worst);
    EXPECT_LE(worst, 0.07);
    for (std::size_t i = 0; i < picture.pixels.size(); i += 4) {
        EXPECT_NEAR(picture.pixels[i], 0.5F * picture.pixels[i + 1], 1e-5F);
        EXPECT_NEAR(picture.pixels[i + 2], 0.25F * picture.pixels[i + 1], 1e-5F);
    }
}

TEST(BlinnPhong, PlacesAndScalesTheHighlightCorrectly) {
    Shot shot = ball_shot();
    shot.scene.ambient = 0;
    shot.scene.lights = {directional_light({0.9, -1, 0.6})};
    shot.scene.lights[0].intensity = 1;
    shot.scene.materials[1].response = {.ambient = 0, .diffuse = 0, .specular = 0.8, .shininess = 20};
    const glm::dvec3 l = glm::normalize(glm::dvec3(0.9, -1, 0.6));
    const auto glossy = [&](const glm::dvec3& n, const glm::dvec3& v) {
        if (!(glm::dot(n, l) > 0)) return 0.0;
        return 0.8 * std::pow(std::max(glm::dot(n, glm::normalize(l + v)), 0.0), 20.0);
    };
    const Image picture = render(shot).color;
    const double worst = worst_on_ball(shot, picture, 0.85, glossy);
    float highest = 0;
    for (std::size_t i = 0; i < picture.pixels.size(); i += 4)
        highest = std::max(highest, picture.pixels[i]);
    std::printf("highlight: worst %.4f, height %.4f of 0.8\n", worst, static_cast<double>(highest));
    EXPECT_LE(worst, 0.08);
    EXPECT_NEAR(highest, 0.8F, 0.02F);
    // A light of twice the intensity doubles the highlight.
    shot.scene.lights[0].intensity = 2;
    const Image twice = render(shot).color;
    for (std::size_t i = 0; i < picture.pixels.size(); i += 4)
        ASSERT_NEAR(twice.pixels[i], 2 * picture.pixels[i], 1e-5F);
}

TEST(Silhouette, DarkensABallTowardsItsRim) {
    Shot shot = ball_shot();
    shot.scene.lights.clear();
    shot.scene.effects.silhouette = Silhouette{{0, 0, 0}, 0.9, 2};
    const auto rim = [](const glm::dvec3& n, const glm::dvec3& v) {
        return 1 - 0.9 * std::pow(1 - std::abs(glm::dot(n, v)), 2.0);
    };
    const double worst = worst_on_ball(shot, render(shot).color, 0.9, rim);
    std::printf("silhouette: worst %.4f\n", worst);
    EXPECT_LE(worst, 0.04);
}

TEST(Fog, DependsOnDepthByTheClosedForm) {
    // A wall perpendicular to the view, 30 mm away: the ratio of pictures with and without fog only depends on depth.
    Shot shot;
    shot.volume = std::make_shared<const Volume>(sample(plane_scene({32, 32, 24}, {0, 0, -1}, {0, 0, 10})));
    shot.scene.iso_values = {0.5};
    shot.scene.materials = {{}, {{1, 0.8, 0.6}, 12}};
    shot.camera = look(*shot.volume, {15.3, 15.8, -20}, {15.3, 15.8, 10}, 20, {0, 1, 0});
    for (const SheetCut sheets : {SheetCut::Whole, SheetCut::Sliced}) {
        shot.settings.sheets = sheets;
        shot.scene.effects.fog.reset();
        const RenderResult clear = render(shot, {.depth = true});
        const double density = 0.03, start = 12;
        shot.scene.effects.fog = Fog{{0, 0, 0}, density, start};
        const Image foggy = render(shot).color;
        shot.scene.effects.fog->color = {0.2, 0.4, 1};
        const Image blue = render(shot).color;
        double worst = 0;
        for (int y = 8; y < 56; ++y) {
            for (int x = 8; x < 56; ++x) {
                const double depth = static_cast<double>(clear.depth->at(x, y, 0));
                // A kernel's splat lies up to a voxel and a half behind the surface.
                EXPECT_NEAR(depth, 30.3, 0.7);
                const double want = std::exp(-density * (depth - start));
                const double share =
                    static_cast<double>(foggy.at(x, y, 1)) / static_cast<double>(clear.color.at(x, y, 1));
                worst = std::max(worst, std::abs(share - want));
                EXPECT_NEAR(blue.at(x, y, 2), foggy.at(x, y, 2) + (1 - static_cast<float>(want)), 5e-3F);
            }
        }
        std::printf("fog: share off by %.1e\n", worst);
        EXPECT_LE(worst, 3e-3);
    }
}

TEST(Fog, ChangesNeitherBackgroundNorOpacity) {
    Shot shot = torus_shot();
    shot.settings.pixels = PixelChoice::Every;  // colours decide which pixels are drawn
    shot.scene.background = {0.2, 0.5, 0.9};
    const Image clear = render(shot).color;
    shot.scene.effects.fog = Fog{{1, 1, 1}, 0.1, 5};
    const Image foggy = render(shot).color;
    int outside = 0;
    for (std::size_t i = 0; i < clear.pixels.size(); i += 4) {
        ASSERT_EQ(foggy.pixels[i + 3], clear.pixels[i + 3]);
        if (clear.pixels[i + 3] > 0) continue;
        ++outside;
        for (std::size_t c = 0; c < 3; ++c)
            ASSERT_EQ(foggy.pixels[i + c], clear.pixels[i + c]);
    }
    EXPECT_GT(outside, 500);
}

TEST(TransferFunction, IsExactForARampInALinearField) {
    // Values rise by 1 per voxel along z; seen along y, every row has one value.
    Shot shot;
    shot.volume = sampled({24, 24, 32}, [](const glm::dvec3& x) { return 100 + x.z; });
    shot.scene.transfer = {
        {100, {0, 0, 1}, 5}, {112, {0.75, 0, 0.25}, 5}, {120, {0.25, 1, 0.25}, 5}, {131, {1, 1, 1}, 5}};
    shot.scene.iso_values.clear();
    shot.scene.materials = {{}};
    shot.scene.lights.clear();
    shot.settings.saturation = 1;
    shot.width = 16;
    shot.height = 128;
    shot.camera = camera_at({11.5, 11.5, 15.5}, {0, 1, 0}, {1, 0, 0}, shot.height, 4);
    const Image picture = render(shot).color;
    double worst = 0;
    const auto& points = shot.scene.transfer;
    for (int y = 8; y < 120; ++y) {
        // Screen rows go down, z goes up; perspective shifts by at most 0.4 voxel over the depth of the volume.
        const double z = 15.5 - (y + 0.5 - 64) / 4 * (kEyeDistance - 11.5) / kEyeDistance;
        const double value = 100 + z;
        std::size_t i = 0;
        while (i + 2 < points.size() && points[i + 1].value <= value)
            ++i;
        const double t = (value - points[i].value) / (points[i + 1].value - points[i].value);
        // Kernels of 1.6 voxels round the kinks.
        const bool kink = std::min(std::abs(value - 112), std::abs(value - 120)) < 1.7 || z < 1.7 || z > 29.3;
        if (kink) continue;
        for (int c = 0; c < 3; ++c)
            worst = std::max(worst, std::abs(static_cast<double>(picture.at(8, y, c)) -
                                             glm::mix(points[i].color, points[i + 1].color, t)[c]));
    }
    std::printf("ramp: worst %.1e\n", worst);
    EXPECT_LE(worst, 4e-3);
}

TEST(TransferFunction, GivesTheSamePictureAsEquivalentMaterials) {
    // Steps of a transfer function between iso-values, far from any classified value, are equivalent to materials.
    Shot shot = torus_shot();
    const Image materials = render(shot).color;
    const auto& m = shot.scene.materials;
    shot.scene.transfer = {{0.1999, m[0].color, 0},
                           {0.2, m[1].color, m[1].extinction},
                           {0.4999, m[1].color, m[1].extinction},
                           {0.5, m[2].color, m[2].extinction}};
    for (Material& material : shot.scene.materials)
        material.color = {0, 0, 0};
    const Image transfer = render(shot).color;
    const ImageDifference difference = compare_images(materials, transfer, 1e-3);
    std::printf("two ways: largest difference %.1e, %.4f beyond\n", difference.max, difference.share);
    EXPECT_LE(difference.share, 0.002);
}

TEST(TransferFunction, ClassifiesPartialVolumesByAPointFurtherInside) {
    // A bright body in air; between them is a band of values that a plain look-up would show in red.
    Shot shot = ball_shot();
    shot.scene.lights.clear();
    shot.scene.transfer = {{0.35, {1, 0, 0}, 0}, {0.5, {1, 0, 0}, 6}, {0.85, {1, 0, 0}, 6}, {0.9, {1, 1, 1}, 6}};
    shot.scene.materials = {{}, {}};
    const auto green = [&](const Image& picture) {
        return 1 - worst_on_ball(
                       shot, picture, 0.8, [](const glm::dvec3&, const glm::dvec3&) { return 1.0; }, 1);
    };
    EXPECT_GT(green(render(shot).color), 0.7);
    shot.settings.edges = EdgeEstimator::Off;
    EXPECT_LT(green(render(shot).color), 0.5) << "the test data do not need two-sided classification";
}

TEST(Transparency, MatchesAShellInFrontOfAnOpaqueCore) {
    Shot shot;
    const glm::dvec3 centre(19.5);
    shot.volume = sampled({40, 40, 40}, [&](const glm::dvec3& x) {
        const double r = glm::length(x - centre);
        return blurred_step(r - 17) + blurred_step(r - 9);
    });
    shot.scene.iso_values = {0.5, 1.5};
    shot.scene.materials = {{}, {{0.2, 0.4, 1}, 0.08}, {{1, 0.7, 0.2}, 8}};
    shot.scene.lights.clear();
    shot.settings.saturation = 1;
    shot.width = shot.height = 48;
    shot.camera = camera_at(centre, glm::normalize(glm::dvec3(0.4, 1, -0.3)),
                            glm::normalize(glm::cross(glm::dvec3(0.4, 1, -0.3), glm::dvec3(0, 0, 1))), 48, 2);
    const double passed = std::exp(-0.08 * (17 - 9));
    const glm::dvec3 want = (1 - passed) * glm::dvec3(0.2, 0.4, 1) + passed * glm::dvec3(1, 0.7, 0.2);
    for (const SheetCut sheets : {SheetCut::Whole, SheetCut::Sliced}) {
        shot.settings.sheets = sheets;
        const Image picture = render(shot).color;
        double worst = 0;
        for (int y = 22; y < 26; ++y)
            for (int x = 22; x < 26; ++x)
                for (int c = 0; c < 3; ++c)
                    worst = std::max(worst, std::abs(static_cast<double>(picture.at(x, y, c)) - want[c]));
        std::printf("shell and core: worst %.4f\n", worst);
        EXPECT_LE(worst, 0.02);
    }
}

TEST(Shading, StaysFiniteForVanishingDirections) {
    Shot shot;
    // Uniform except for one voxel: most gradients are 0.
    shot.volume = sampled({16, 16, 16}, [](const glm::dvec3& x) { return x == glm::dvec3(8) ? 1.0 : 0.6; });
    shot.scene.iso_values = {0.5};
    shot.scene.materials = {{}, {{1, 1, 1}, 0.2, {.specular = 1, .shininess = 1000}}};
    Light at_voxel;
    at_voxel.kind = Light::Kind::Point;
    at_voxel.position = {8, 8, 8};
    shot.scene.lights = {at_voxel, Light{}, directional_light({0, 0, 1e-150})};
    shot.scene.effects.silhouette = Silhouette{{0, 0, 0}, 1, 0.25};
    shot.scene.effects.fog = Fog{{1, 1, 1}, 1e6, 0};
    shot.width = shot.height = 32;
    for (const glm::dvec3& eye : {glm::dvec3(3, 4, 5), glm::dvec3(8, 8, 8), glm::dvec3(1e7, -2e7, 1e7)}) {
        shot.camera = look(*shot.volume, eye, glm::dvec3(7.5, 8, 9), eye.x > 100 ? 1e-4 : 60);
        for (const bool transfer : {false, true}) {
            shot.scene.transfer.clear();
            if (transfer) shot.scene.transfer = {{0.1, {1, 0, 0}, 0}, {0.6, {0, 1, 0}, 0.5}};
            EXPECT_TRUE(within(render(shot).color, 0, 4));
        }
    }
    shot.volume = sampled({8, 8, 8}, [](const glm::dvec3&) { return 3.0; });
    shot.scene.iso_values.clear();
    shot.scene.materials = {{}};
    shot.scene.transfer = {{2, {0, 0, 0}, 0}, {4, {1, 1, 1}, 2}};
    shot.camera = look(*shot.volume, {3, -20, 3}, {3, 3, 3}, 30);
    const Image constant = render(shot).color;
    EXPECT_TRUE(within(constant, 0, 4));
    EXPECT_GT(constant.at(16, 16, 3), 0.9F) << "a constant volume must be classified, too";
}

TEST(Lights, RayCastersRefuseMoreThanOneLightAndOtherEffects) {
    Shot shot = torus_shot();
    shot.scene.lights.resize(2);
    render(shot);
    const auto cast = [&] {
        return test_renderer().raycast(shot.scene, shot.camera, shot.settings, RaycastSettings{}, 16, 16);
    };
    EXPECT_THROW(cast(), Error);
    shot.scene.lights.resize(1);
    EXPECT_NO_THROW(cast());
    shot.scene.effects.fog = Fog{};
    EXPECT_THROW(cast(), Error);
    const AnalyticScene truth = sphere_scene({16, 16, 16}, glm::dvec3(8), 5);
    const Volume volume = sample(truth);
    Scene scene;
    scene.iso_values = {0.5};
    scene.materials = {{}, {{1, 1, 1}, 2}};
    const Camera camera = look(volume, {8, -20, 8}, {8, 8, 8}, 30);
    EXPECT_NO_THROW(reference::truth(truth, volume.geometry, scene, camera, 4, 4, {.tolerance = 0.05}));
    scene.effects.silhouette = Silhouette{};
    EXPECT_THROW(reference::truth(truth, volume.geometry, scene, camera, 4, 4, {.tolerance = 0.05}), Error);
}

}  // namespace
}  // namespace edgesplat::test
