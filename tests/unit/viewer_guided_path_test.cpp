// Guided paths through cavities, compared with centre lines.
#include "engine/viewer/guided_path.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <iostream>

#include "engine/volume/load_volume.h"
#include "tests/unit/refusal.h"
#include "tests/unit/viewer_volumes.h"

namespace edgesplat::viewer {
namespace {

using namespace viewer_test;

/// A point on the centre line of the bent tube.
glm::dvec3 bend_at(double angle) {
    return {6 + kBend * std::cos(angle), 6 + kBend * std::sin(angle), 24};
}

double off_the_bend(const glm::dvec3& p) {
    return std::hypot(std::hypot(p.x - 6, p.y - 6) - kBend, p.z - 24);
}

void expect_even(const GuidedPath& path, double voxel) {
    ASSERT_GE(path.points.size(), 2U);
    ASSERT_EQ(path.points.size(), path.room.size());
    const double step = path.length / static_cast<double>(path.points.size() - 1);
    EXPECT_GT(step, 0.6 * voxel);
    EXPECT_LT(step, 1.5 * voxel);
    for (std::size_t i = 1; i < path.points.size(); ++i)
        EXPECT_NEAR(glm::length(path.points[i] - path.points[i - 1]), step, 0.1 * step);
}

TEST(ViewerGuidedPath, FollowsCentreLineOfBentTube) {
    for (const glm::dvec3& spacing : {glm::dvec3(1), glm::dvec3(1, 1, 3)}) {
        const Cavity tube = bent_tube(spacing);
        const Walls walls(sampled(tube), solid_scene());
        const auto path = guided_path(walls, bend_at(0.15), bend_at(1.4));
        ASSERT_TRUE(path);
        expect_even(*path, 1);
        EXPECT_EQ(path->points.front(), bend_at(0.15));
        EXPECT_EQ(path->points.back(), bend_at(1.4));
        double worst = 0;
        for (std::size_t i = 0; i < path->points.size(); ++i) {
            worst = std::max(worst, off_the_bend(path->points[i]));
            EXPECT_NEAR(path->room[i], tube.room(path->points[i]), spacing.z > 1 ? 0.7 : 0.6);
        }
        std::cout << "off the centre line: " << worst << " mm\n";
        EXPECT_LT(worst, 1);
        EXPECT_NEAR(path->length, kBend * 1.25, 1.5);
    }
}

TEST(ViewerGuidedPath, ReachesCentreLineFromSide) {
    const Cavity tube = bent_tube();
    const Walls walls(sampled(tube), solid_scene());
    const glm::dvec3 from = bend_at(0.15) + glm::dvec3(3, 0, 3);
    const auto path = guided_path(walls, from, bend_at(1.4));
    ASSERT_TRUE(path);
    EXPECT_EQ(path->points.front(), from);
    for (std::size_t i = 9; i < path->points.size(); ++i)
        EXPECT_LT(off_the_bend(path->points[i]), 1.2) << i;
}

TEST(ViewerGuidedPath, HandlesObliqueVolumes) {
    const Cavity tube = straight_tube();
    const Walls walls(sampled(tube), solid_scene());
    const auto path = guided_path(walls, tube.to_world({22, 25, 8}), tube.to_world({24, 23, 55}));
    ASSERT_TRUE(path);
    for (std::size_t i = 6; i + 6 < path->points.size(); ++i) {
        const glm::dvec3 own = tube.to_own(path->points[i]);
        EXPECT_LT(std::hypot(own.x - 23.2, own.y - 24.1), 1) << i;
    }
}

TEST(ViewerGuidedPath, CrossesMazeWithoutTouchingWalls) {
    for (const glm::dvec3& spacing : {glm::dvec3(1), glm::dvec3(3, 1, 1)}) {
        const Cavity cavity = maze(spacing);
        const auto volume = sampled(cavity);
        const Walls walls(volume, solid_scene());
        const auto path = guided_path(walls, glm::dvec3(11.5), {11.5, 35.5, 35.5});
        ASSERT_TRUE(path);
        expect_even(*path, 1);
        for (std::size_t i = 0; i < path->points.size(); ++i) {
            EXPECT_LT(trilinear(*volume, path->points[i]), 0.5);
            EXPECT_GT(path->room[i], 0.9) << i;
            EXPECT_EQ(path->room[i], walls.distance(path->points[i]));
        }
    }
}

TEST(ViewerGuidedPath, FindsNoPathBetweenSeparateCavities) {
    const Cavity cavity = shell();
    Cavity two = cavity;
    two.room = [=](const glm::dvec3& x) { return std::max(cavity.room(x), 8 - glm::length(x - glm::dvec3(23.5))); };
    const Walls walls(sampled(two), solid_scene());
    const glm::dvec3 middle = two.to_world(glm::dvec3(23.5)), hull = two.to_world(two.inside);
    EXPECT_FALSE(guided_path(walls, middle, hull));
    EXPECT_TRUE(guided_path(walls, middle, middle + glm::dvec3(3, 2, 1)));
    EXPECT_TRUE(guided_path(walls, hull, two.to_world({23.5, 23.5, 41})));
    EXPECT_FALSE(guided_path(walls, middle, middle));
    EXPECT_FALSE(guided_path(walls, {NAN, 0, 0}, middle));
    EXPECT_FALSE(guided_path(walls, {INFINITY, 0, 0}, middle));
    // There is no path in from the corner of the volume.
    EXPECT_FALSE(guided_path(walls, {0, 0, 0}, middle));
}

// Sheets between voxels are walls, too.
TEST(ViewerGuidedPath, DoesNotCrossThinSheets) {
    Cavity step = hollow_ball(32, 5);
    step.blur = 0;
    step.room = [](const glm::dvec3& x) { return glm::dot(x, glm::normalize(glm::dvec3(1, 0.4, 0.3))) - 20.3; };
    Scene scene;
    scene.iso_values = {0.3, 0.7};
    scene.materials = {{}, {{}, 8}, {}};
    const Walls walls(sampled(step), scene);
    EXPECT_FALSE(guided_path(walls, {4, 4, 4}, {28, 28, 28}));
}

TEST(ViewerGuidedPath, MovesEndsOutOfWalls) {
    const Cavity tube = bent_tube();
    const Walls walls(sampled(tube), solid_scene());
    const glm::dvec3 from = bend_at(0.3) + glm::dvec3(0, 0, 8);
    ASSERT_TRUE(walls.solid(from));
    const auto path = guided_path(walls, from, bend_at(1.2));
    ASSERT_TRUE(path);
    EXPECT_GT(tube.room(path->points.front()), 0);
    EXPECT_LT(glm::length(path->points.front() - from), 5);
    EXPECT_FALSE(guided_path(walls, bend_at(0.3) + glm::dvec3(0, 0, 14), bend_at(1.2)));
}

TEST(ViewerGuidedPath, StartsOutsideVolume) {
    Cavity open = straight_tube();
    open.room = [](const glm::dvec3& x) { return 6.3 - glm::length(glm::dvec2(x) - glm::dvec2(23.2, 24.1)); };
    const Walls walls(sampled(open), solid_scene());
    const glm::dvec3 from = open.to_world({30, 24, -40});
    const auto path = guided_path(walls, from, open.to_world({23, 24, 50}));
    ASSERT_TRUE(path);
    EXPECT_EQ(path->points.front(), from);
    EXPECT_GT(path->length, 85);
    for (const glm::dvec3& p : path->points)
        EXPECT_FALSE(walls.solid(p));
}

TEST(ViewerGuidedPath, CamerasFollowPath) {
    const Cavity tube = bent_tube();
    const Walls walls(sampled(tube), solid_scene());
    const auto path = guided_path(walls, bend_at(0.1), bend_at(1.45));
    ASSERT_TRUE(path);
    // Including views along `up`: the tube begins along +y and ends along -x.
    for (const glm::dvec3& up : {glm::dvec3(0, 0, 1), glm::dvec3(1, 0, 0), glm::dvec3(0, 1, 0)}) {
        const CameraPath keys = camera_path_along(*path, 12, 70, up);
        EXPECT_NEAR(duration(keys), 12, 1e-12);
        CameraFrame before = camera_frame(camera_along(*path, 0, 70, up));
        EXPECT_LT(glm::length(before.eye - path->points.front()), 1e-9);
        for (double s = 0; s <= path->length; s += 0.2) {
            const Camera camera = camera_along(*path, s, 70, up);
            const CameraFrame frame = camera_frame(camera);
            EXPECT_EQ(camera.fov_y, 70);
            EXPECT_LT(off_the_bend(frame.eye), 1.1);
            EXPECT_LT(glm::length(frame.eye - before.eye), 0.3);
            EXPECT_GT(glm::dot(frame.forward, before.forward), std::cos(0.05)) << s;
            EXPECT_GT(glm::dot(frame.up, before.up), std::cos(0.1)) << s;
            const CameraFrame movie = camera_frame(camera_at(keys, s / path->length * 12));
            EXPECT_LT(glm::length(movie.eye - frame.eye), 1e-6);
            before = frame;
        }
        EXPECT_LT(glm::length(camera_along(*path, 1e9, 70, up).eye - path->points.back()), 1e-9);
        EXPECT_LT(glm::length(camera_along(*path, NAN, 70, up).eye - path->points.front()), 1e-9);
    }
    EXPECT_NE(refusal([&] { camera_path_along(*path, 0, 70, {0, 0, 1}); }).find("seconds"), std::string::npos);
    EXPECT_NE(refusal([&] { camera_path_along(*path, 1, 190, {0, 0, 1}); }), "");
    EXPECT_NE(refusal([&] { camera_path_along({}, 1, 70, {0, 0, 1}); }).find("no length"), std::string::npos);
}

TEST(ViewerGuidedPath, CrossesRealNose) {
    const char* folder = std::getenv("EDGESPLAT_DATA");
    if (folder == nullptr || *folder == '\0') GTEST_SKIP() << "EDGESPLAT_DATA is not set: no folder of real volumes";
    const auto volume = std::make_shared<const Volume>(load_volume(std::string(folder) + "/cranium_ct/cranium.nhdr"));
    Scene scene = solid_scene();
    scene.iso_values = {-400};
    const Walls walls(volume, scene);
    const glm::dvec3 nose = volume->geometry.to_world({128, 148, 14});
    ASSERT_FALSE(walls.solid(nose));
    // Targets behind the nose; a target in matter moves to nearby air. The last path begins outside the head.
    for (const auto& [from, back] : {std::pair{nose, 70}, {nose, 64}, {nose, 20}, {nose - glm::dvec3(0, 300, 0), 64}}) {
        const auto start = std::chrono::steady_clock::now();
        const auto path = guided_path(walls, from, volume->geometry.to_world({128, 148 + back, 14}));
        const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
        ASSERT_TRUE(path) << back;
        std::cout << back << " voxels back: " << path->length << " mm, " << seconds << " s\n";
        EXPECT_GT(volume->geometry.to_index(path->points.back()).y, 148 + back - 7);
        for (const glm::dvec3& p : path->points)
            EXPECT_FALSE(walls.solid(p));
    }
}

}  // namespace
}  // namespace edgesplat::viewer
