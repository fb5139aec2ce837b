// Walls, compared with shapes of known distance.
#include "engine/viewer/walls.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <iostream>
#include <string>

#include "engine/volume/load_volume.h"
#include "engine/volume/pack_volume.h"
#include "engine/volume/packed_volume.h"
#include "tests/unit/refusal.h"
#include "tests/unit/viewer_random.h"
#include "tests/unit/viewer_volumes.h"

namespace edgesplat::viewer {
namespace {

using namespace viewer_test;

/// Largest error of the distance at random places, mm: near the surface and far from it.
struct Errors {
    double near = 0, far = 0;
    int wrong_sides = 0;
};
Errors errors(const Cavity& cavity, bool within_matter = true, int count = 4000) {
    const Walls walls(sampled(cavity), solid_scene());
    Random random(7);
    Errors e;
    const glm::dvec3 size = glm::dvec3(cavity.dims - 1) * cavity.spacing;
    for (int i = 0; i < count; ++i) {
        const glm::dvec3 own = random.in(glm::dvec3(0), size), world = cavity.to_world(own);
        const double expected = cavity.room(own), found = walls.distance(world);
        if (expected < 0 && !within_matter) continue;
        // Matter ends at the sides of the volume.
        const glm::dvec3 to_side = glm::min(own, size - own) + cavity.spacing / 2.0;
        if (expected < 0 && -expected > std::min({to_side.x, to_side.y, to_side.z})) continue;
        double& worst = std::abs(expected) < 2 * walls.voxel() ? e.near : e.far;
        worst = std::max(worst, std::abs(found - expected));
        if (std::abs(expected) > 0.2 * walls.voxel()) e.wrong_sides += (found < 0) != (expected < 0) ? 1 : 0;
        EXPECT_EQ(found < 0, walls.solid(world)) << cavity.name << ' ' << i << ": " << found;
    }
    return e;
}

TEST(ViewerWalls, DistancesMatchShape) {
    for (const Cavity& cavity : {hollow_ball(), straight_tube(), bent_tube(), shell()}) {
        // In the matter around the ends of tubes `room` is not a distance, and samples do not resolve the rims.
        const bool has_rims = cavity.name != "shell" && cavity.name != "hollow ball";
        const Errors e = errors(cavity, !has_rims);
        EXPECT_LT(e.near, has_rims ? 0.4 : 0.12) << cavity.name;
        EXPECT_LT(e.far, 0.4) << cavity.name;
        EXPECT_EQ(e.wrong_sides, 0) << cavity.name;
    }
}

TEST(ViewerWalls, HandleAnisotropicObliqueVolumes) {
    Cavity cavity = hollow_ball();
    cavity.spacing = {1, 1, 3};
    cavity.dims = {48, 48, 16};
    cavity.axes = kTurned;
    cavity.origin = {-100, 50, 20};
    cavity.blur = 2;  // an edge wide enough for samples 3 mm apart
    const Errors e = errors(cavity);
    // Chords of 3 mm in a circle of 16 mm radius are 0.07 mm inside of it.
    EXPECT_LT(e.near, 0.25);
    EXPECT_LT(e.far, 0.7);
    EXPECT_EQ(e.wrong_sides, 0);
}

// In binary data the surface of the interpolated field lies up to half a voxel from the true one.
TEST(ViewerWalls, HandleBinaryData) {
    Cavity cavity = hollow_ball();
    cavity.blur = 0;
    const Errors e = errors(cavity);
    EXPECT_LT(e.near, 1.0);
    EXPECT_LT(e.far, 1.0);
}

TEST(ViewerWalls, AwayPointsToFreeSpace) {
    const Cavity ball = hollow_ball();
    const Walls walls(sampled(ball), solid_scene());
    Random random(7);
    for (int i = 0; i < 500; ++i) {
        const glm::dvec3 d = random.direction(), world = ball.inside + d * random(4, 20);
        EXPECT_NEAR(glm::length(walls.away(world)), 1, 1e-12);
        EXPECT_GT(glm::dot(walls.away(world), -d), 0.98);
    }
    EXPECT_NEAR(glm::length(walls.away(ball.inside)), 1, 1e-12);
}

TEST(ViewerWalls, NothingIsSolidOutsideVolume) {
    const Cavity ball = hollow_ball();
    const Walls walls(sampled(ball), solid_scene());
    // The sides of the volume are matter.
    EXPECT_FALSE(walls.solid({-0.6, 23, 23}));
    EXPECT_TRUE(walls.solid({-0.4, 23, 23}));
    EXPECT_NEAR(walls.distance({-10.5, 23, 23}), 10, 1e-9);
    EXPECT_NEAR(walls.distance({0.5, 5, 5}), -1, 1e-9);
    EXPECT_GT(walls.away({0.5, 5, 5}).x, -1.01);
    EXPECT_LT(walls.away({0.5, 5, 5}).x, -0.99);
    EXPECT_NEAR(walls.free_distance({-20.5, 23, 23}, {2, 0, 0}), 20, 1e-6);
    EXPECT_EQ(walls.free_distance({-20.5, 23, 23}, {-1, 0, 0}, 500), 500);
    EXPECT_NEAR(walls.free_distance(ball.inside, {0, 1, 0}), 16, 0.1);
    EXPECT_EQ(walls.free_distance({1, 5, 5}, {0, 1, 0}), 0);
    // An open cavity.
    Cavity half = ball;
    half.room = [](const glm::dvec3& x) { return 20.25 - x.x; };
    const Walls block(sampled(half), solid_scene());
    EXPECT_LE(block.distance({-30, 23, 23}), 50.3);
    EXPECT_GE(block.distance({-30, 23, 23}), 35);
    EXPECT_NEAR(block.distance({10, 23, 80}), std::hypot(10.25, 80 - 47.5), 0.2);
}

TEST(ViewerWalls, HandleEmptyAndSolidVolumes) {
    const Cavity ball = hollow_ball(16, 5);
    const auto volume = sampled(ball);
    Scene scene = solid_scene(0.1);
    const Walls none(volume, scene);
    EXPECT_FALSE(none.any());
    EXPECT_EQ(none.distance(ball.inside), INFINITY);
    EXPECT_FALSE(none.solid({1, 1, 1}));
    EXPECT_EQ(none.free_distance({0, 0, 0}, {1, 1, 1}), INFINITY);
    EXPECT_NEAR(glm::length(none.away({0, 0, 0})), 1, 1e-12);
    scene.materials[0].extinction = scene.materials[1].extinction = 8;
    const Walls all(volume, scene);
    EXPECT_TRUE(all.any());
    EXPECT_NEAR(all.distance(ball.inside), -8, 1e-9);
    EXPECT_NEAR(all.distance({-3, 5, 5}), 2.5, 1e-9);
    // A volume of one slice.
    auto flat = std::make_shared<Volume>();
    flat->geometry.dims = {8, 8, 1};
    for (int i = 0; i < 64; ++i)
        flat->values.push_back(i % 8 < 4 ? 1.0F : 0.0F);
    finish_volume(*flat);
    const Walls sheet(flat, solid_scene());
    EXPECT_NEAR(sheet.distance({6, 4, 0}), 2.5, 1e-6);
    EXPECT_TRUE(sheet.solid({1, 4, 0.4}));
    EXPECT_FALSE(sheet.solid({1, 4, 0.6}));
}

TEST(ViewerWalls, FollowMaterialsAndTransferFunctions) {
    Cavity ramp = hollow_ball(32, 5);
    ramp.blur = 0;
    auto volume = std::make_shared<Volume>(*sampled(ramp));
    for (int i = 0; i < 32 * 32 * 32; ++i)
        volume->values[static_cast<std::size_t>(i)] = static_cast<float>(i % 32);
    finish_volume(*volume);
    Scene scene;
    scene.iso_values = {5, 10, 20};
    // ln 2 = 0.693 per mm is the limit at voxels of 1 mm.
    scene.materials = {{}, {{}, 0.7}, {{}, 0.69}, {{}, 3}};
    const Walls materials(volume, scene);
    const auto place = [](double x) { return glm::dvec3(x, 15.3, 14.8); };
    for (const auto& [x, solid] :
         {std::pair{4.9, false}, {5.1, true}, {9.9, true}, {10.1, false}, {19.9, false}, {20.1, true}})
        EXPECT_EQ(materials.solid(place(x)), solid) << x;
    EXPECT_NEAR(materials.distance(place(14)), 4, 1e-6);
    EXPECT_NEAR(materials.distance(place(17)), 3, 1e-6);
    EXPECT_NEAR(materials.distance(place(7)), -2, 1e-6);
    scene.transfer = {{8, {}, 0}, {10, {}, 2 * std::log(2.0)}, {11, {}, 0}};
    const Walls transfer(volume, scene);
    // A thin layer from 9 to 10.5.
    EXPECT_FALSE(transfer.solid(place(8.9)));
    EXPECT_TRUE(transfer.solid(place(9.1)));
    EXPECT_TRUE(transfer.solid(place(10.4)));
    EXPECT_FALSE(transfer.solid(place(10.6)));
    EXPECT_NEAR(transfer.distance(place(4)), 5, 1e-6);
    EXPECT_NEAR(transfer.distance(place(15)), 4.5, 1e-6);
    EXPECT_NEAR(transfer.distance(place(9.6)), -0.6, 1e-6);
}

// The voxels on both sides are free; only the layer between them is solid.
TEST(ViewerWalls, FindLayersBetweenTwoVoxels) {
    Cavity step = hollow_ball(32, 5);
    step.blur = 0;
    step.room = [](const glm::dvec3& x) { return x.x - 12.5; };
    Scene scene;
    scene.iso_values = {0.3, 0.7};
    scene.materials = {{}, {{}, 8}, {}};
    const Walls walls(sampled(step), scene);
    EXPECT_TRUE(walls.solid({12.5, 10, 10}));
    EXPECT_NEAR(walls.distance({12.5, 10, 10}), -0.2, 1e-6);
    EXPECT_NEAR(walls.distance({20, 10, 10}), 7.3, 1e-5);
    EXPECT_NEAR(walls.distance({6, 10, 10}), 6.3, 1e-5);
    EXPECT_NEAR(walls.free_distance({20, 10, 10}, {-1, 0, 0}), 7.3, 1e-5);
}

TEST(ViewerWalls, ClipPlanesOpenWalls) {
    const Cavity ball = hollow_ball();
    Scene scene = solid_scene();
    scene.effects.clip.keep = {{ball.inside, {0, 0, 5}}};
    const auto volume = sampled(ball);
    const Walls walls(volume, scene);
    const glm::dvec3 above = ball.inside + glm::dvec3(20, 0, 3), below = ball.inside + glm::dvec3(20, 0, -1);
    EXPECT_FALSE(walls.solid(above));
    EXPECT_NEAR(walls.distance(above), 3, 1e-9);
    EXPECT_TRUE(walls.solid(below));
    EXPECT_NEAR(walls.distance(below), -1, 1e-9);
    EXPECT_GT(walls.away(above).z, 0.99);
    EXPECT_NEAR(walls.free_distance(ball.inside - glm::dvec3(0, 0, 4), {0, 0, -1}), 12, 0.1);
    EXPECT_EQ(walls.free_distance(ball.inside, {0, 0, 1}, 100), 100);
    // A box cut out at the side of +x, from the same matter.
    Clip box;
    box.remove = {{ball.inside + glm::dvec3(10, 0, 0), {-1, 0, 0}},
                  {ball.inside + glm::dvec3(0, 3, 0), {0, 1, 0}},
                  {ball.inside - glm::dvec3(0, 3, 0), {0, -1, 0}}};
    const Walls open(walls, box);
    EXPECT_FALSE(open.solid(ball.inside + glm::dvec3(20, 2.9, 0)));
    EXPECT_TRUE(open.solid(ball.inside + glm::dvec3(20, 3.1, 0)));
    EXPECT_NEAR(open.distance(ball.inside + glm::dvec3(20, 1, 0)), 2, 1e-9);
    EXPECT_EQ(open.free_distance(ball.inside, {1, 0, 0}, 100), 100);
    EXPECT_TRUE(open.solid(ball.inside + glm::dvec3(18, 8, 3)));
    EXPECT_LT(open.distance_at({43, 27, 23}), 0);
    EXPECT_GT(open.distance_at({43, 24, 23}), 0);
}

TEST(ViewerWalls, PackedVolumeGivesSameResult) {
    const Cavity ball = hollow_ball();
    const auto volume = sampled(ball);
    const auto file =
        std::filesystem::temp_directory_path() / ("edgesplat-viewer-walls-" + std::to_string(getpid()) + ".h5");
    pack_volume(*volume, file.string());
    const auto packed = std::make_shared<const Volume>(open_packed(file.string()));
    const Walls walls(volume, solid_scene()), same(packed, solid_scene());
    std::filesystem::remove(file);
    EXPECT_EQ(same.dims(), walls.dims());
    for (const double x : {0.0, 5.5, 13.0, 17.5})
        EXPECT_EQ(same.distance(ball.inside + glm::dvec3(x, 1, 2)), walls.distance(ball.inside + glm::dvec3(x, 1, 2)));
}

TEST(ViewerWalls, RefuseInvalidArguments) {
    EXPECT_NE(refusal([] { Walls(nullptr, solid_scene()); }).find("no volume"), std::string::npos);
    EXPECT_NE(refusal([] { Walls(std::make_shared<const Volume>(), solid_scene()); }).find("samples"),
              std::string::npos);
    EXPECT_NE(refusal([] { Walls(sampled(hollow_ball(8, 2)), Scene{}); }), "");
}

TEST(ViewerWalls, SurroundAirInRealHead) {
    const char* folder = std::getenv("EDGESPLAT_DATA");
    if (folder == nullptr || *folder == '\0') GTEST_SKIP() << "EDGESPLAT_DATA is not set: no folder of real volumes";
    const auto volume = std::make_shared<const Volume>(load_volume(std::string(folder) + "/cranium_ct/cranium.nhdr"));
    Scene scene = solid_scene();
    scene.iso_values = {-400};
    const auto start = std::chrono::steady_clock::now();
    const Walls walls(volume, scene);
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    std::cout << "walls of " << volume->values.size() << " voxels: " << seconds << " s\n";
    EXPECT_FALSE(walls.solid(volume->geometry.to_world({128, 148, 14})));
    EXPECT_GT(walls.distance(volume->geometry.to_world({2, 2, 100})), 0);
}

}  // namespace
}  // namespace edgesplat::viewer
