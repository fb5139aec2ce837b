// Kernels cut at faces, compared with exact pictures and with the ray caster.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

#include "engine/scene/transfer_function.h"
#include "tests/properties/exact_scenes.h"

namespace edgesplat::test {
namespace {

/// Minimum gain. With noise of 5 % of the step, faces are not better yet: exact normals follow the noise, but the ray
/// caster's differences over two voxels smooth it. The bound prevents a further loss.
struct Gain {
    const char* scene;
    double over_rays;       ///< dB, minimum, over the trilinear ray caster
    double extinction = 8;  ///< per voxel; at .1 light is also evaluated in the depth of the matter
};

/// PSNR of the ray caster's picture against the truth.
double by_rays(const Exact& scene, RaycastFilter filter) {
    const Shot& shot = scene.shot;
    return decibels(test_renderer()
                        .raycast(shot.scene, shot.camera, shot.settings, {.filter = filter}, shot.width, shot.height)
                        .color,
                    scene.truth);
}

/// PSNR of the pictures by faces and by rays against the truth, dB; also printed.
struct Nearness {
    double faces, trilinear, cubic;
};

Nearness nearness(const Exact& scene) {
    const Nearness n{decibels(render(scene.shot).color, scene.truth), by_rays(scene, RaycastFilter::Trilinear),
                     by_rays(scene, RaycastFilter::Cubic)};
    std::printf("faces %.1f dB, rays %.1f, cubic %.1f\n", n.faces, n.trilinear, n.cubic);
    return n;
}

/// An opaque builtin scene in 64 pixels, from one point (index space) towards another; field of view in degrees.
Exact seen_from(const char* name, const glm::dvec3& eye, const glm::dvec3& target, double fov) {
    const AnalyticScene scene = builtin_scene(name);
    Shot shot;
    shot.volume = std::make_shared<const Volume>(sample(scene));
    shot.scene.iso_values = scene.iso_values;
    shot.scene.materials = {{}, {{1, 0.85, 0.75}, 8}};
    shot.camera = look(*shot.volume, eye, target, fov);
    shot.width = shot.height = 64;
    return exact_shot(scene, shot);
}

class NearerToTheTruth : public testing::TestWithParam<Gain> {};

TEST_P(NearerToTheTruth, ThanTheRayCaster) {
    const Exact scene = exact_scene(GetParam().scene, GetParam().extinction);
    const double faces = decibels(render(scene.shot).color, scene.truth);
    const double rays = by_rays(scene, RaycastFilter::Trilinear);
    const double cubic = by_rays(scene, RaycastFilter::Cubic);
    std::printf("%s: faces %.1f dB, rays %.1f, cubic %.1f\n", GetParam().scene, faces, rays, cubic);
    EXPECT_GE(faces - rays, GetParam().over_rays);
    // Where a face does not agree with the field, rays search the field: never much worse than cubic rays.
    if (!draws_surfaces(scene.shot.settings, scene.shot.scene, *scene.shot.volume)) return;
    EXPECT_GE(faces - cubic, -0.3);
}

INSTANTIATE_TEST_SUITE_P(Scenes, NearerToTheTruth,
                         testing::Values(Gain{"tilted-torus", 3}, Gain{"ellipsoid", 3}, Gain{"small-ball", 4},
                                         Gain{"rounded-box", 3}, Gain{"box", 1}, Gain{"shell", 3}, Gain{"balls", 1},
                                         Gain{"gyroid", 0.5}, Gain{"vessels", 4}, Gain{"specks", 5},
                                         Gain{"ellipsoid:noise=0.05", -2.5}, Gain{"tilted-torus", 3, 0.1},
                                         Gain{"shell", 7, 0.1}, Gain{"gyroid", 4, 0.1}, Gain{"vessels", 7, 0.1},
                                         Gain{"specks", 5, 0.1}, Gain{"plates", 2, 0.1}),
                         [](const auto& test) {
                             std::string name = test.param.scene;
                             if (test.param.extinction < 1) name += "_translucent";
                             std::replace_if(
                                 name.begin(), name.end(),
                                 [](char c) { return std::isalnum(static_cast<unsigned char>(c)) == 0; }, '_');
                             return name;
                         });

/// Most of a layer thinner than a voxel lies between samples: voxels beside it carry it.
TEST(Faces, ShowAThinLayerOnACoreBetterThanRays) {
    // The core of the shell is a thin wall, the balls touch, the gyroid has narrow gaps.
    for (const auto& [name, gain] : {std::pair{"ellipsoid", 1.0}, {"shell", -0.3}, {"balls", -0.3}, {"gyroid", -0.3}}) {
        SCOPED_TRACE(name);
        AnalyticScene scene = builtin_scene(fmt::format("builtin:{}:32", name));
        scene.iso_values = {0.25, 0.6};
        const auto [faces, trilinear, cubic] = nearness(exact_scene(scene, 8, {{0.2, 0.5, 0.9}, 0.1}));
        EXPECT_GE(faces - cubic, gain);
        EXPECT_GE(faces - trilinear, gain > 0 ? 6 : 0);
    }
}

/// Like skin over bone: a layer of two voxels in which the field rises to a plateau, and then to the opaque core.
AnalyticScene ball_in_a_skin() {
    AnalyticScene scene = sphere_scene(glm::ivec3(32), {15.6, 15.3, 15.8}, 11.3);
    const auto skin = [](const glm::dvec3& x) {
        const double s = 11.3 - glm::length(x - glm::dvec3(15.6, 15.3, 15.8));
        const auto step = [](double t) { return 0.5 * std::erfc(-t / (0.7 * std::sqrt(2.0))); };
        return 0.55 * step(s) + 0.45 * step(s - 2);
    };
    scene.iso_values = {0.3, 0.7};
    scene.value = skin;
    scene.gradient = [](const glm::dvec3& x) { return glm::dvec3(15.6, 15.3, 15.8) - x; };
    return scene;
}

/// A voxel of the core carries matter of the layer; its matter of the core must not occlude it.
TEST(Faces, OfACoreDoNotOccludeTheLayerInFront) {
    const Exact exact = exact_scene(ball_in_a_skin(), 8, {{0.2, 0.5, 0.9}, 0.3});
    const auto [faces, trilinear, cubic] = nearness(exact);
    EXPECT_GE(faces - std::max(trilinear, cubic), 2);
}

/// Between two iso-values the field is monotonic, and so is the light, also from nearby.
TEST(Faces, OfALayerBetweenTwoValuesAreLitMonotonically) {
    const AnalyticScene scene = builtin_scene("builtin:phantom:noise=0");
    Shot shot;
    shot.volume = std::make_shared<const Volume>(sample(scene));
    shot.scene.iso_values = scene.iso_values;
    shot.scene.materials = {{}, {{1, 1, 1}, 0.15}, {{0, 0, 0}, 8}};
    shot.camera = look(*shot.volume, {47.5, 60, 180}, {47.5, 52, 90}, 15);
    shot.width = shot.height = 64;
    const auto [faces, trilinear, cubic] = nearness(exact_shot(scene, shot));
    EXPECT_GE(faces - cubic, -3);
}

/// A volume, and a surface in it, continues straight for half a voxel beyond its outermost samples.
TEST(Faces, OfABallCutByTheBorderHaveNoFlange) {
    const glm::ivec3 dims(24, 22, 20);
    const Exact scene = exact_scene(sphere_scene(dims, glm::dvec3(dims - 1) / 2.0, 11.8));
    const auto [faces, trilinear, cubic] = nearness(scene);
    EXPECT_GE(faces - trilinear, 5);
    EXPECT_GE(faces - cubic, -0.3);
}

/// The cut of a thin wall at the border: rays enter the volume in the wall, and leave the wall through its side.
TEST(Faces, OfAWallCutByTheBorderHaveNoComb) {
    Exact scene = seen_from("builtin:plates", {46.07, -4.6, 26.96}, {46.07, 10, 26.96}, 35);
    // Surfaces have no soft rim, which matter of 8 per voxel has where the cut is thin.
    const auto [surfaces, trilinear, cubic] = nearness(scene);
    EXPECT_GE(surfaces - trilinear, -0.3);
    scene.shot.settings.opaque = OpaqueMatter::Kernels;
    EXPECT_GE(decibels(render(scene.shot).color, scene.truth) - trilinear, 0.5);
}

TEST(Faces, OfABinaryCubeHaveSharpEdgesAndCorners) {
    // The corner in the middle of the picture, and three edges: the spline rounds them by a voxel.
    const auto [faces, trilinear, cubic] = nearness(seen_from("builtin:cube-hole", {-9, -6, -12}, {4, 4, 4}, 14));
    EXPECT_GE(faces, 30.5);
    EXPECT_GE(faces - std::max(trilinear, cubic), 8);
}

TEST(Faces, GiveDepthAndNormalOfTheSurface) {
    const Exact scene = exact_scene("small-ball");
    Shot shot = scene.shot;
    const RenderResult result = render(shot, {.depth = true, .normal = true});
    ASSERT_TRUE(result.depth && result.normal);
    // The ball's centre is not exactly the grid's: it is computed as the mean of the points that the normals lead to.
    const CameraFrame frame = camera_frame(shot.camera);
    int seen = 0;
    double worst = 0;
    std::vector<glm::dvec3> middles;
    for (int y = 0; y < shot.height; ++y)
        for (int x = 0; x < shot.width; ++x) {
            const std::size_t at =
                static_cast<std::size_t>(y) * static_cast<std::size_t>(shot.width) + static_cast<std::size_t>(x);
            if (!(result.color.pixels[4 * at + 3] > 0.999F)) continue;
            const double sx = (2 * (x + 0.5) / shot.width - 1) * frame.tan_half_y;
            const double sy = (1 - 2 * (y + 0.5) / shot.height) * frame.tan_half_y;
            const auto depth = static_cast<double>(result.depth->pixels[at]);
            const glm::dvec3 n(result.normal->pixels[3 * at], result.normal->pixels[3 * at + 1],
                               result.normal->pixels[3 * at + 2]);
            const glm::dvec3 place = frame.eye + depth * (frame.forward + sx * frame.right + sy * frame.up);
            middles.push_back(place - 4.0 * n);
            ++seen;
        }
    ASSERT_GT(seen, 100);
    glm::dvec3 mean(0);
    for (const glm::dvec3& m : middles)
        mean += m / static_cast<double>(seen);
    for (const glm::dvec3& m : middles)
        worst = std::max(worst, glm::length(m - mean));
    EXPECT_LE(worst, 0.25) << "voxels";
}

TEST(Faces, GiveFiniteNumbersForDegenerateData) {
    // Thin grids, constant values, a single voxel, pure noise: the picture is finite and within 0 and 1.
    for (const glm::ivec3 dims :
         {glm::ivec3(1, 9, 9), glm::ivec3(9, 2, 9), glm::ivec3(3, 3, 3), glm::ivec3(12, 12, 12)}) {
        for (int kind = 0; kind < 4; ++kind) {
            Shot shot;
            unsigned state = 1;
            shot.volume = sampled(dims, [&](const glm::dvec3& x) {
                state = state * 1664525U + 1013904223U;
                if (kind == 0) return (state >> 16U) / 65536.0;
                if (kind == 1) return glm::length(x - glm::dvec3(dims / 2)) < 0.5 ? 1.0 : 0.0;
                if (kind == 2) return x.x + x.y > 4 ? 1.0 : 0.0;
                return 0.7;
            });
            shot.scene = two_tone(0.2, 5);
            shot.scene.lights = {Light{}};
            shot.camera = look(*shot.volume, glm::dvec3(dims) * 1.6 + 3.0, glm::dvec3(dims) / 2.0, 50);
            shot.width = shot.height = 40;
            const Image image = render(shot).color;
            for (const float value : image.pixels)
                ASSERT_TRUE(value >= 0 && value <= 1.001F) << dims.x << " " << kind;
        }
    }
}

}  // namespace
}  // namespace edgesplat::test
