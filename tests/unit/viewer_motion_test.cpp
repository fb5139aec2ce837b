// Motion of the eye: independent of the frame rate, smooth, and never through walls.
#include "engine/viewer/motion.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <random>
#include <set>
#include <tuple>
#include <vector>

#include "engine/viewer/screen.h"
#include "tests/unit/refusal.h"
#include "tests/unit/viewer_volumes.h"

namespace edgesplat::viewer {
namespace {

using namespace viewer_test;

constexpr double kFrame = 1.0 / 60;

Camera camera_of(const glm::dvec3& eye, const glm::dvec3& direction, const glm::dvec3& up = {0, 0, 1}) {
    return {eye, direction, up, 45};
}

Motion orbiting() {
    Motion motion;
    motion.set_home(camera_of({0, -100, 0}, {0, 1, 0}), glm::dvec3(0));
    motion.jump(camera_of({0, -100, 0}, {0, 1, 0}));
    motion.set_center(glm::dvec3(0));
    return motion;
}

void rest(Motion& motion) {
    for (int i = 0; i < 600 && motion.moving(); ++i)
        motion.step({}, kFrame);
    EXPECT_FALSE(motion.moving());
}

bool same(const Camera& a, const Camera& b) {
    return a.eye == b.eye && a.direction == b.direction && a.up == b.up && a.fov_y == b.fov_y;
}

/// Largest difference of the eyes (divided by `scale`), view directions and up directions.
double difference(const Camera& a, const Camera& b, double scale) {
    const CameraFrame f = camera_frame(a), g = camera_frame(b);
    return std::max({glm::length(f.eye - g.eye) / scale, glm::length(f.forward - g.forward), glm::length(f.up - g.up)});
}

Controls parts(Controls c, int count) {
    c.look /= count;
    c.orbit /= count;
    c.pan /= count;
    c.zoom /= count;
    return c;
}

TEST(ViewerMotion, IsIndependentOfFrameRate) {
    Controls fly, orbit;
    fly.move = {0.3, -0.2, 0.9};
    fly.look = {0.3, -0.1};
    fly.roll = 0.5;
    orbit.orbit = {0.4, 0.2};
    orbit.pan = {0.1, -0.05};
    orbit.zoom = 2;
    for (const auto& [mode, controls] : {std::pair{MotionMode::Fly, fly}, {MotionMode::Orbit, orbit}}) {
        std::vector<Motion> motions;
        for (const int count : {1, 2, 10, 40}) {
            Motion motion = orbiting();
            motion.set_mode(mode);
            for (int i = 0; i < count; ++i)
                motion.step(parts(controls, count), 0.1 / count);
            for (int i = 0; i < count; ++i)
                motion.step({}, 0.1 / count);
            motions.push_back(motion);
        }
        const double way = difference(orbiting().camera(), motions[0].camera(), 100);
        EXPECT_GT(way, 0.1);
        for (const Motion& motion : motions)
            EXPECT_LT(difference(motion.camera(), motions.back().camera(), 100), 0.01 * way) << int(mode);
    }
}

TEST(ViewerMotion, SlowAndFastFramesReachSamePlace) {
    for (const double seconds : {0.5, 0.004}) {
        Motion motion = orbiting();
        motion.set_mode(MotionMode::Fly);
        Controls controls;
        controls.move.z = 1;
        for (double t = 0; t < 1 - 1e-9; t += seconds)
            motion.step(controls, seconds);
        // speed() is twice the distance to the centre per second, at most half an extent per second (50 mm/s).
        EXPECT_NEAR(motion.camera().eye.y, -100 + 50 * (1 - 0.12), 0.3) << seconds;
        EXPECT_EQ(motion.camera().eye.x, 0);
    }
}

TEST(ViewerMotion, ComesToRestAndStaysThere) {
    for (const MotionMode mode : {MotionMode::Orbit, MotionMode::Fly}) {
        Motion motion = orbiting();
        motion.set_mode(mode);
        EXPECT_FALSE(motion.moving());
        Controls controls;
        controls.orbit = {0.3, 0.1};
        controls.look = {0.2, 0.1};
        controls.move = {0, 0, 1};
        controls.zoom = -1;
        controls.roll = 1;
        motion.step(controls, kFrame);
        EXPECT_TRUE(motion.moving());
        rest(motion);
        const Camera camera = motion.camera();
        motion.step({}, 1);
        EXPECT_TRUE(same(camera, motion.camera()));
    }
}

TEST(ViewerMotion, OrbitKeepsCentreDistanceAndUp) {
    Motion motion = orbiting();
    motion.set_center({10, 5, 3});
    const glm::ivec2 size(400, 300);
    const glm::dvec2 pixel = *project(motion.camera(), size, motion.center());
    const double distance = glm::length(motion.camera().eye - motion.center());
    glm::dvec3 right = camera_frame(motion.camera()).right;
    Controls controls;
    controls.orbit = {0.05, 0.03};
    for (int i = 0; i < 200; ++i) {
        motion.step(controls, kFrame);
        const CameraFrame frame = camera_frame(motion.camera());
        EXPECT_GE(frame.up.z, -1e-9);
        EXPECT_NEAR(frame.right.z, 0, 1e-9);
        EXPECT_GT(glm::dot(right, frame.right), 0.99) << "the picture flips at " << i;
        right = frame.right;
        EXPECT_NEAR(glm::length(frame.eye - motion.center()), distance, 1e-9 * distance);
        EXPECT_LT(glm::length(*project(motion.camera(), size, motion.center()) - pixel), 1e-6);
    }
    // The eye stops above the pole; the opposite control brings it down again.
    EXPECT_NEAR(camera_frame(motion.camera()).forward.z, -1, 1e-9);
    controls.orbit = {0, -0.05};
    for (int i = 0; i < 30; ++i)
        motion.step(controls, kFrame);
    rest(motion);
    EXPECT_NEAR(camera_frame(motion.camera()).forward.z, -std::cos(1.5), 1e-3);
    EXPECT_NEAR(camera_frame(motion.camera()).right.z, 0, 1e-9);
}

TEST(ViewerMotion, OrbitGoesRightAndUp) {
    Motion motion = orbiting();
    Controls controls;
    controls.orbit = {0.1, 0};
    motion.step(controls, kFrame);
    rest(motion);
    EXPECT_NEAR(motion.camera().eye.x, 100 * std::sin(0.1), 0.01);
    controls.orbit = {0, 0.1};
    motion.step(controls, kFrame);
    rest(motion);
    EXPECT_NEAR(motion.camera().eye.z, 100 * std::sin(0.1), 0.01);
}

TEST(ViewerMotion, OrbitLevelsRolledCamera) {
    Motion motion = orbiting();
    motion.jump(camera_of({0, -100, 0}, {0, 1, 0}, {1, 0, 1}));
    motion.set_center(glm::dvec3(0));
    Controls controls;
    controls.orbit = {0.02, 0};
    double tilt = camera_frame(motion.camera()).up.z;
    EXPECT_NEAR(tilt, std::sqrt(0.5), 1e-9);
    for (int i = 0; i < 250; ++i) {
        motion.step(controls, kFrame);
        EXPECT_GE(camera_frame(motion.camera()).up.z, tilt - 1e-12);
        tilt = camera_frame(motion.camera()).up.z;
    }
    EXPECT_NEAR(tilt, 1, 1e-3);
    // A roll made in this mode stays.
    controls = {};
    controls.roll = 1;
    for (int i = 0; i < 30; ++i)
        motion.step(controls, kFrame);
    rest(motion);
    const double rolled = camera_frame(motion.camera()).up.z;
    EXPECT_LT(rolled, 0.9);
    controls = {};
    controls.orbit = {0.01, 0};
    motion.step(controls, kFrame);
    rest(motion);
    EXPECT_NEAR(camera_frame(motion.camera()).up.z, rolled, 0.02);
}

// Seen from a pole, the picture's own up defines the level.
TEST(ViewerMotion, LeavesAPoleThroughTheBottomOfThePicture) {
    Motion motion = orbiting();
    motion.jump(camera_of({0, 0, 100}, {0, 0, -1}, {0.6, 0.8, 0}));
    motion.set_center(glm::dvec3(0));
    Controls controls;
    controls.orbit = {0, -0.3};
    motion.step(controls, kFrame);
    rest(motion);
    const glm::dvec3 eye = motion.camera().eye;
    EXPECT_NEAR(eye.z, 100 * std::cos(0.3), 0.01);
    EXPECT_NEAR(eye.x / eye.y, 0.75, 1e-6);
    EXPECT_LT(eye.y, 0);
}

TEST(ViewerMotion, PansAndZooms) {
    Motion motion = orbiting();
    const glm::ivec2 size(400, 300);
    const glm::dvec3 mark(1, 0, 2);
    const glm::dvec2 before = *project(motion.camera(), size, mark);
    Controls controls;
    controls.pan = {0.25, 0.1};
    motion.step(controls, kFrame);
    rest(motion);
    const glm::dvec2 shift = *project(motion.camera(), size, mark) - before;
    EXPECT_NEAR(shift.x, -75, 0.05);
    EXPECT_NEAR(shift.y, 30, 0.05);
    EXPECT_LT(glm::length(*project(motion.camera(), size, motion.center()) - glm::dvec2(200, 150)), 1e-6);
    controls = {};
    controls.zoom = 3;
    motion.step(controls, kFrame);
    rest(motion);
    EXPECT_NEAR(glm::length(motion.camera().eye - motion.center()), 100 * std::pow(0.85, 3), 0.01);
    controls.zoom = -100;
    for (int i = 0; i < 50; ++i)
        motion.step(controls, kFrame);
    rest(motion);
    EXPECT_LE(glm::length(motion.camera().eye), 801);
    controls.zoom = 100;
    for (int i = 0; i < 50; ++i)
        motion.step(controls, kFrame);
    rest(motion);
    EXPECT_GT(glm::length(motion.camera().eye - motion.center()), 0);
}

TEST(ViewerMotion, FlyTurnsInTheCamerasFrame) {
    Motion motion = orbiting();
    motion.set_mode(MotionMode::Fly);
    Controls controls;
    controls.look = {0.2, 0};
    motion.step(controls, kFrame);
    rest(motion);
    EXPECT_NEAR(camera_frame(motion.camera()).forward.x, std::sin(0.2), 1e-4);
    controls.look = {0, 0.2};
    motion.step(controls, kFrame);
    rest(motion);
    EXPECT_NEAR(camera_frame(motion.camera()).forward.z, std::sin(0.2), 1e-4);
    const glm::dvec3 up = camera_frame(motion.camera()).up, right = camera_frame(motion.camera()).right;
    controls = {};
    controls.roll = 1;
    motion.step(controls, kFrame);
    rest(motion);
    EXPECT_GT(glm::dot(camera_frame(motion.camera()).up, right), 0.01);
    EXPECT_LT(glm::dot(camera_frame(motion.camera()).up, up), 1);
    EXPECT_EQ(motion.camera().eye, glm::dvec3(0, -100, 0));
}

TEST(ViewerMotion, TransitsEndExactlyOrStopOnInput) {
    Motion motion = orbiting();
    const Camera there{{40, 50, 60}, {-1, -2, -2.5}, {0, 0.1, 3}, 30};
    motion.fly_to(there, {3, 4, 5}, 0.7);
    EXPECT_TRUE(motion.moving());
    glm::dvec3 eye = motion.camera().eye;
    double longest = 0;
    for (int i = 0; i < 60 && motion.moving(); ++i) {
        motion.step({}, kFrame);
        longest = std::max(longest, glm::length(motion.camera().eye - eye));
        eye = motion.camera().eye;
    }
    EXPECT_TRUE(same(motion.camera(), there));
    EXPECT_EQ(motion.center(), glm::dvec3(3, 4, 5));
    EXPECT_FALSE(motion.moving());
    EXPECT_LT(longest, 15) << "the motion is eased, not a jump";
    motion.home();
    motion.step({}, 0.2);
    Controls controls;
    controls.zoom = 1;
    motion.step(controls, kFrame);
    EXPECT_FALSE(motion.travelling());
    rest(motion);
    EXPECT_GT(glm::length(motion.camera().eye - glm::dvec3(0, -100, 0)), 1);
    motion.home();
    for (int i = 0; i < 200; ++i)
        motion.step({}, kFrame);
    EXPECT_TRUE(same(motion.camera(), camera_of({0, -100, 0}, {0, 1, 0})));
    EXPECT_EQ(motion.center(), glm::dvec3(0));
    motion.fly_to(there, {3, 4, 5}, 0);
    EXPECT_TRUE(same(motion.camera(), there));
    EXPECT_NE(refusal([&] { motion.fly_to({{0, 0, 0}, {0, 0, 0}}, glm::dvec3(0), 1); }), "");
    EXPECT_NE(refusal([&] { motion.jump({{0, NAN, 0}}); }), "");
    EXPECT_TRUE(same(motion.camera(), there));
}

// Halfway from front to back the eye is beside the object, not inside it.
TEST(ViewerMotion, TransitsGoAroundTarget) {
    Motion motion = orbiting();
    motion.fly_to(camera_of({1, 100, 0}, {-0.01, -1, 0}), glm::dvec3(0), 1);
    while (motion.travelling()) {
        motion.step({}, kFrame);
        EXPECT_NEAR(glm::length(motion.camera().eye), 100, 1);
    }
}

TEST(ViewerMotion, CameraStaysFiniteForAnyControls) {
    std::mt19937 engine(3);
    const auto junk = [&] {
        const double values[] = {0, 1, -1, 0.3, NAN, INFINITY, -INFINITY, 1e300, -1e300, 1e-300, 7};
        return values[engine() % std::size(values)];
    };
    const Cavity ball = hollow_ball(24, 8);
    for (const bool walls : {false, true}) {
        Motion motion = orbiting();
        if (walls) motion.set_walls(std::make_shared<Walls>(sampled(ball), solid_scene()));
        for (int i = 0; i < 3000; ++i) {
            if (i % 50 == 0) motion.set_mode(i % 100 == 0 ? MotionMode::Fly : MotionMode::Orbit);
            if (i % 500 == 0) motion.home();
            Controls c;
            c.move = {junk(), junk(), junk()};
            c.look = {junk(), junk()};
            c.orbit = {junk(), junk()};
            c.pan = {junk(), junk()};
            c.roll = junk();
            c.zoom = junk();
            c.boost = junk();
            motion.step(c, i % 7 == 0 ? junk() : kFrame);
            const CameraFrame frame = camera_frame(motion.camera());
            ASSERT_TRUE(std::isfinite(glm::dot(frame.eye, frame.eye))) << i;
            ASSERT_TRUE(std::isfinite(motion.speed()));
            ASSERT_LT(glm::length(frame.eye), 1e4);
        }
        motion.home();
        for (int i = 0; i < 200; ++i)
            motion.step({}, kFrame);
        EXPECT_EQ(motion.camera().eye, glm::dvec3(0, -100, 0));
    }
}

Motion flying(const Cavity& cavity, const std::shared_ptr<const Walls>& walls) {
    Motion motion;
    motion.set_walls(walls);
    motion.set_mode(MotionMode::Fly);
    motion.jump(camera_of(cavity.to_world(cavity.inside), {1, 0.2, 0.1}));
    return motion;
}

TEST(ViewerMotion, SpeedFollowsWallDistance) {
    const Cavity ball = hollow_ball();
    Motion motion = flying(ball, std::make_shared<Walls>(sampled(ball), solid_scene()));
    motion.jump(camera_of(ball.inside + glm::dvec3(0, 3, 0), {0, 1, 0}));
    EXPECT_NEAR(motion.speed(), 26, 0.5);
    motion.jump(camera_of(ball.inside + glm::dvec3(11, 0, 0), {0, 1, 0}));
    EXPECT_NEAR(motion.speed(), 10, 0.5);
    motion.jump(camera_of(ball.inside + glm::dvec3(15.9, 0, 0), {0, 1, 0}));
    EXPECT_EQ(motion.speed(), 5);
    motion.jump(camera_of(ball.inside + glm::dvec3(1e5, 0, 0), {0, 1, 0}));
    EXPECT_NEAR(motion.speed(), 48 * std::sqrt(3.0) / 2, 1e-9);
}

TEST(ViewerMotion, OrbitsAroundWallAhead) {
    const Cavity ball = hollow_ball();
    Motion motion = flying(ball, std::make_shared<Walls>(sampled(ball), solid_scene()));
    motion.jump(camera_of(ball.inside, {0, -1, 0}));
    motion.set_center(ball.inside + glm::dvec3(3, 0, 0));
    motion.set_mode(MotionMode::Orbit);
    EXPECT_LT(glm::length(motion.center() - ball.inside - glm::dvec3(0, -16, 0)), 0.2);
}

/// Controls that move the eye in a world direction.
Controls towards(const Motion& motion, const glm::dvec3& way) {
    const CameraFrame f = camera_frame(motion.camera());
    Controls c;
    c.move = {glm::dot(way, f.right), glm::dot(way, f.up), glm::dot(way, f.forward)};
    return c;
}

TEST(ViewerMotion, SlidesAlongWalls) {
    const Cavity tube = straight_tube();
    Motion motion = flying(tube, std::make_shared<Walls>(sampled(tube), solid_scene()));
    // Into the wall at 60 degrees.
    const glm::dvec3 way = tube.axes * glm::dvec3(std::sin(1.05), 0, std::cos(1.05));
    for (int i = 0; i < 600; ++i)
        motion.step(towards(motion, way), kFrame);
    const glm::dvec3 own = tube.to_own(motion.camera().eye);
    EXPECT_GT(own.z, 50) << "the eye stopped at the wall";
    EXPECT_NEAR(tube.room(own), Motion::kClearance, 0.25);
    rest(motion);
    motion.set_collisions(false);
    for (int i = 0; i < 600; ++i)
        motion.step(towards(motion, way), kFrame);
    EXPECT_LT(tube.room_at(motion.camera().eye), -1);
}

// Through a hole little wider than the least clearance, approached off-centre.
TEST(ViewerMotion, SqueezesThroughNarrowPassages) {
    Cavity cavity = hollow_ball();
    cavity.room = [](const glm::dvec3& x) {
        const double rooms =
            std::min(10 - std::abs(std::abs(x.x - 24) - 14), 8 - glm::length(glm::dvec2(x.y - 24, x.z - 24)));
        const double hole = std::min(0.7 - glm::length(glm::dvec2(x.y - 24, x.z - 24)), 6 - std::abs(x.x - 24));
        return std::max(rooms, hole);
    };
    cavity.inside = {10, 24, 24};
    Motion motion = flying(cavity, std::make_shared<Walls>(sampled(cavity), solid_scene()));
    for (int i = 0; i < 900; ++i)
        motion.step(towards(motion, glm::normalize(glm::dvec3(1, 0.05, -0.05))), kFrame);
    EXPECT_GT(motion.camera().eye.x, 40);
}

// Constant motion into a wall: the eye stands still there without trembling.
TEST(ViewerMotion, StandsStillAtAWall) {
    const Cavity ball = hollow_ball();
    Motion motion = flying(ball, std::make_shared<Walls>(sampled(ball), solid_scene()));
    const glm::dvec3 way = glm::normalize(glm::dvec3(1, 2, -1));
    for (int i = 0; i < 300; ++i)
        motion.step(towards(motion, way), kFrame);
    for (int i = 0; i < 100; ++i) {
        const glm::dvec3 before = motion.camera().eye;
        motion.step(towards(motion, way), kFrame);
        EXPECT_LT(glm::length(motion.camera().eye - before), 0.03);
    }
    EXPECT_NEAR(ball.room_at(motion.camera().eye), Motion::kClearance, 0.2);
}

TEST(ViewerMotion, LeavesMatterItStartsIn) {
    for (const Cavity& cavity : {hollow_ball(), maze()}) {
        const auto walls = std::make_shared<Walls>(sampled(cavity), solid_scene());
        std::mt19937 engine(11);
        std::uniform_real_distribution<double> any(2, 45);
        int tried = 0;
        while (tried < 10) {
            const glm::dvec3 place(any(engine), any(engine), any(engine));
            if (cavity.room(place) > -1) continue;
            ++tried;
            Motion motion = flying(cavity, walls);
            motion.jump(camera_of(cavity.to_world(place), {0, 1, 0}));
            const glm::dvec3 way = glm::normalize(cavity.to_world(cavity.inside) - motion.camera().eye);
            for (int i = 0; i < 3000 && !(walls->distance(motion.camera().eye) > 1); ++i)
                motion.step(towards(motion, way), kFrame);
            EXPECT_GT(cavity.room_at(motion.camera().eye), 0) << cavity.name;
            for (int i = 0; i < 300; ++i) {
                motion.step(towards(motion, -way), kFrame);
                ASSERT_GT(cavity.room_at(motion.camera().eye), -0.5) << "went back into the wall of " << cavity.name;
            }
        }
    }
}

/// A random flight against the walls: 10^4 frames or more; each heading is held for a while.
void push_about(const Cavity& cavity, double least_visited, int frames = 10000) {
    SCOPED_TRACE(cavity.name + (cavity.spacing != glm::dvec3(1) ? ", anisotropic" : ""));
    const auto volume = sampled(cavity);
    const auto walls = std::make_shared<Walls>(volume, solid_scene());
    const double voxel = std::min({cavity.spacing.x, cavity.spacing.y, cavity.spacing.z});
    std::mt19937 engine(static_cast<unsigned>(cavity.name.size()));
    std::uniform_real_distribution<double> signed_unit(-1, 1), unit(0, 1);
    const auto direction = [&] {
        for (;;) {
            const glm::dvec3 v(signed_unit(engine), signed_unit(engine), signed_unit(engine));
            if (glm::length(v) > 0.1 && glm::length(v) < 1) return glm::normalize(v);
        }
    };
    constexpr double kBlock = 6;  // mm
    const auto block_of = [&](const glm::dvec3& own) {
        const glm::ivec3 b(glm::floor(own / kBlock));
        return std::tuple(b.x, b.y, b.z);
    };
    std::set<std::tuple<int, int, int>> blocks, visited;
    for (double z = 0; z < cavity.dims.z * cavity.spacing.z; ++z)
        for (double y = 0; y < cavity.dims.y * cavity.spacing.y; ++y)
            for (double x = 0; x < cavity.dims.x * cavity.spacing.x; ++x)
                if (cavity.room({x, y, z}) > 1.5) blocks.insert(block_of({x, y, z}));

    Motion motion = flying(cavity, walls);
    double deepest = -1e9;
    int held = 0, in_matter = 0, stuck = 0;
    glm::dvec3 way(0);
    Controls turns;
    for (int frame = 0; frame < frames; ++frame) {
        if (held-- <= 0) {
            held = 10 + static_cast<int>(unit(engine) * 140);
            // Half of the headings lead to a distant visible place, so that the eye enters passages, too.
            way = direction();
            if (unit(engine) < 0.5) {
                const glm::dvec3 eye = motion.camera().eye;
                const auto in_sight = [&](const glm::dvec3& goal) {
                    for (int k = 1; k <= 20; ++k)
                        if (cavity.room_at(glm::mix(eye, goal, k / 20.0)) < 0.5) return false;
                    return true;
                };
                glm::dvec3 goal = eye + direction();
                for (int i = 0; i < 200; ++i) {
                    const glm::dvec3 further = eye + direction() * (30 * unit(engine));
                    if (glm::length(further - eye) > glm::length(goal - eye) && in_sight(further)) goal = further;
                }
                way = glm::normalize(goal - eye);
            }
            turns = {};
            turns.look = {0.02 * signed_unit(engine), 0.02 * signed_unit(engine)};
            turns.roll = signed_unit(engine);
            turns.boost = unit(engine) < 0.5 ? 5 : 1;
        }
        Controls controls = towards(motion, way);
        controls.look = turns.look;
        controls.roll = turns.roll;
        controls.boost = turns.boost;
        motion.step(controls, frame % 97 == 0 ? 0.15 : kFrame);
        const glm::dvec3 eye = motion.camera().eye, own = cavity.to_own(eye);
        deepest = std::max(deepest, -cavity.room(own) / voxel);
        in_matter += trilinear(*volume, eye) >= 0.5 ? 1 : 0;
        if (blocks.contains(block_of(own))) visited.insert(block_of(own));
        if (frame % 100 != 0) continue;
        // At least one heading leads away within a second.
        bool free = false;
        for (int attempt = 0; attempt < 30 && !free; ++attempt) {
            Motion probe = motion;
            const glm::dvec3 heading = direction();
            for (int i = 0; i < 60 && !free; ++i) {
                probe.step(towards(probe, heading), kFrame);
                free = glm::length(probe.camera().eye - eye) > voxel;
            }
        }
        stuck += free ? 0 : 1;
    }
    EXPECT_LT(deepest, 0.5);
    EXPECT_EQ(in_matter, 0);
    EXPECT_EQ(stuck, 0);
    const double share = static_cast<double>(visited.size()) / static_cast<double>(blocks.size());
    EXPECT_GT(share, least_visited);
    std::cout << cavity.name << (cavity.spacing != glm::dvec3(1) ? ", anisotropic" : "") << ": deepest " << deepest
              << " voxel, " << visited.size() << " of " << blocks.size() << " blocks\n";
}

TEST(ViewerMotion, StaysInsideBall) {
    push_about(hollow_ball(), 0.5);
}
TEST(ViewerMotion, StaysInsideTube) {
    push_about(straight_tube(), 0.5);
}
TEST(ViewerMotion, StaysInsideBentTube) {
    push_about(bent_tube(), 0.5);
}
TEST(ViewerMotion, StaysInsideAnisotropicTube) {
    push_about(bent_tube({1, 1, 3}), 0.5);
}
TEST(ViewerMotion, StaysInsideShell) {
    push_about(shell(), 0.5);
}
TEST(ViewerMotion, StaysInsideMaze) {
    push_about(maze(), 0.5, 20000);
}
TEST(ViewerMotion, StaysInsideAnisotropicMaze) {
    push_about(maze({3, 1, 1}), 0.5, 20000);
}

}  // namespace
}  // namespace edgesplat::viewer
