// Camera paths: they pass through their keys, are smooth, never flip, and rotate with their keys.
#include "engine/scene/camera_path.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "engine/error.h"

namespace edgesplat {
namespace {

using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

const CameraPath kPaths[] = {
    {{{0, {0, -100, 0}, {0, 0, 0}, {0, 0, 1}, 45}}, false},
    {{{0, {0, -100, 0}, {0, 0, 0}, {0, 0, 1}, 45}, {2, {100, 0, 40}, {5, 3, 0}, {0, 0, 1}, 30}}, false},
    {{{-1, {0, -100, 0}, {0, 0, 0}, {0, 0, 1}, 45},
      {2, {100, 0, 40}, {5, 3, 0}, {0, 0.2, 1}, 30},
      {2.5, {110, 30, 60}, {5, 3, 0}, {0, 0.2, 1}, 60},
      {6, {0, 90, 150}, {-20, 3, 10}, {-1, 0, 0}, 60},
      {7, {0, 90, 150}, {-20, 3, 10}, {-1, 0, 0}, 60},
      {9, {-60, 10, -30}, {0, 0, 0}, {0, 0, -1}, 50}},
     false},
    {{{0, {100, 0, 30}, {0, 0, 0}, {0, 0, 1}, 45},
      {1, {0, 100, 30}, {0, 0, 0}, {0, 0, 1}, 45},
      {2, {-100, 0, 30}, {0, 0, 0}, {0, 0, 1}, 45},
      {3, {0, -100, 30}, {0, 0, 0}, {0, 0, 1}, 45},
      {4, {100, 0, 30}, {0, 0, 0}, {0, 0, 1}, 45}},
     true},
    // Over the top, past the direction of `up`: the view continues upside down.
    {{{0, {0, -100, 0}, {0, 0, 0}, {0, 0, 1}, 45},
      {1, {0, -70, 70}, {0, 0, 0}, {0, 0, 1}, 45},
      {2, {0, 70, 70}, {0, 0, 0}, {0, 0, -1}, 45}},
     false},
    // The eye and its target swap places: the view has to turn round.
    {{{0, {0, 0, 0}, {0, 50, 0}, {0, 0, 1}, 45}, {3, {0, 50, 0}, {0, 0, 0}, {0, 0, 1}, 45}}, false},
};

void expect_near(const glm::dvec3& a, const glm::dvec3& b, double tolerance, const std::string& what) {
    EXPECT_LT(glm::length(a - b), tolerance)
        << what << fmt::format(": ({}, {}, {}) and ({}, {}, {})", a.x, a.y, a.z, b.x, b.y, b.z);
}

TEST(CameraPath, PassesExactlyThroughItsKeys) {
    for (const CameraPath& path : kPaths)
        for (const CameraKey& key : path.keys) {
            const Camera camera = camera_at(path, key.time);
            const CameraFrame frame = camera_frame(camera);
            const CameraFrame expected = camera_frame({key.eye, key.target - key.eye, key.up, key.fov});
            EXPECT_EQ(camera.eye, key.eye);
            EXPECT_EQ(camera.fov_y, key.fov);
            expect_near(frame.forward, expected.forward, 1e-12, "view");
            expect_near(frame.up, expected.up, 1e-12, "up");
        }
}

TEST(CameraPath, HasContinuousFrameAndRate) {
    constexpr double kStep = 1e-4;
    for (const CameraPath& path : kPaths) {
        const double start = path.keys.front().time;
        const auto frame = [&](double time) { return camera_frame(camera_at(path, time)); };
        // At the inner keys, where pieces meet, and at the steps in which `up` is transported.
        std::vector<double> joints;
        for (std::size_t i = 0; i + 1 < path.keys.size(); ++i)
            for (int k = i == 0 && !path.loop ? 1 : 0; k < 16; ++k)
                joints.push_back(path.keys[i].time + (path.keys[i + 1].time - path.keys[i].time) * k / 16);
        for (const double t : joints) {
            const CameraFrame before = frame(t - kStep), at = frame(t), after = frame(t + kStep);
            const auto smooth = [&](const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c, double size,
                                    const char* what) {
                expect_near((b - a) / kStep, (c - b) / kStep, 0.01 * size,
                            fmt::format("{} at {} of the path from {}", what, t, start));
            };
            smooth(before.eye, at.eye, after.eye, 100, "eye");
            smooth(before.forward, at.forward, after.forward, 1, "view");
            smooth(before.up, at.up, after.up, 1, "up");
        }
    }
}

TEST(CameraPath, NeverFlips) {
    for (const CameraPath& path : kPaths) {
        const int steps = 4000;
        CameraFrame last = camera_frame(camera_at(path, path.keys.front().time));
        for (int k = 1; k <= steps; ++k) {
            const double t = path.keys.front().time + duration(path) * k / steps;
            const CameraFrame frame = camera_frame(camera_at(path, t));
            // The fastest turn in these paths is about 400 degrees per second; a flip would be 180 degrees in one step.
            EXPECT_GT(glm::dot(frame.forward, last.forward), std::cos(0.03)) << t;
            EXPECT_GT(glm::dot(frame.up, last.up), std::cos(0.03)) << t;
            EXPECT_NEAR(glm::dot(frame.up, frame.forward), 0, 1e-12);
            last = frame;
        }
    }
}

TEST(CameraPath, StandsStillAtEqualKeysWithoutOvershoot) {
    const CameraPath& path = kPaths[2];
    for (double t = 6; t <= 7; t += 0.05)
        expect_near(camera_at(path, t).eye, path.keys[3].eye, 1e-12, "standing still");
    // Back and forth along a line, with a stop: the eye never passes a turning point and never reverses between keys.
    CameraPath line;
    const double places[] = {0, 1, 1, 50, 100, 100, 20};
    for (int k = 0; k < 7; ++k)
        line.keys.push_back({double(k), {places[k], 0, 0}, {places[k], 10, 0}});
    for (int k = 0; k < 6; ++k)
        for (int s = 1; s <= 100; ++s) {
            const double a = camera_at(line, k + (s - 1) / 100.0).eye.x, b = camera_at(line, k + s / 100.0).eye.x;
            EXPECT_GE((b - a) * (places[k + 1] >= places[k] ? 1 : -1), -1e-12) << k << " " << s;
            EXPECT_GE(b, std::min(places[k], places[k + 1]) - 1e-12);
            EXPECT_LE(b, std::max(places[k], places[k + 1]) + 1e-12);
        }
}

TEST(CameraPath, RotatesWithItsKeys) {
    std::mt19937 random(7);
    std::normal_distribution<double> normal;
    for (const CameraPath& path : kPaths) {
        const glm::dvec3 a = glm::normalize(glm::dvec3(normal(random), normal(random), normal(random)));
        const glm::dvec3 b = glm::normalize(glm::cross(a, glm::dvec3(normal(random), normal(random), normal(random))));
        const glm::dmat3 rotation(a, b, glm::cross(a, b));
        const glm::dvec3 shift(30, -5, 12);
        CameraPath rotated = path;
        for (CameraKey& key : rotated.keys) {
            key.eye = rotation * key.eye + shift;
            key.target = rotation * key.target + shift;
            key.up = rotation * key.up;
        }
        if (path.loop) {
            rotated.keys.back() = rotated.keys.front();
            rotated.keys.back().time = path.keys.back().time;
        }
        for (int k = 0; k <= 200; ++k) {
            const double t = path.keys.front().time + duration(path) * k / 200;
            const CameraFrame from = camera_frame(camera_at(path, t)), to = camera_frame(camera_at(rotated, t));
            expect_near(rotation * from.eye + shift, to.eye, 1e-9, "eye");
            expect_near(rotation * from.forward, to.forward, 1e-9, "view");
            expect_near(rotation * from.up, to.up, 1e-9, "up");
        }
    }
}

TEST(CameraPath, LoopRepeats) {
    const CameraPath& loop = kPaths[3];
    for (const double t : {0.3, 1.7, 3.9}) {
        expect_near(camera_at(loop, t).eye, camera_at(loop, t + 4).eye, 1e-9, "next round");
        expect_near(camera_at(loop, t).eye, camera_at(loop, t - 8).eye, 1e-9, "two rounds before");
    }
    // A loop around an upright object keeps it upright.
    for (double t = 0; t < 4; t += 0.01)
        EXPECT_NEAR(camera_frame(camera_at(loop, t)).right.z, 0, 1e-12) << t;
}

TEST(CameraPath, OrbitIsACircleAtConstantSpeed) {
    const Camera start{{10, -90, 30}, {0, 1, 0}, {0, 0, 1}, 40};
    for (const double degrees : {360.0, -90.0, 720.0, 3.0}) {
        const glm::dvec3 center(10, 5, 0), axis = glm::normalize(glm::dvec3(0.1, 0.2, 1));
        const CameraPath path = orbit_path({start, center, axis, degrees, 6});
        EXPECT_EQ(path.loop, std::fmod(degrees, 360) == 0);
        const glm::dvec3 arm = start.eye - center;
        for (double t = 0; t <= 6; t += 0.0137) {
            const double angle = glm::radians(degrees) * t / 6;
            const glm::dvec3 expected = center + arm * std::cos(angle) + glm::cross(axis, arm) * std::sin(angle) +
                                        axis * (glm::dot(axis, arm) * (1 - std::cos(angle)));
            const Camera camera = camera_at(path, t);
            expect_near(camera.eye, expected, 1e-4 * glm::length(arm), "on the circle");
            expect_near(camera.eye + camera.direction, center, 1e-9, "looks at the centre");
        }
    }
}

TEST(CameraPath, FlightHasConstantSpeedThroughItsPoints) {
    const FlyThrough flight{{{0, 0, 0}, {40, 10, 0}, {60, 60, 20}, {20, 90, 50}, {-50, 80, 60}}, 12, 15};
    const CameraPath path = fly_through(flight);
    const int steps = 1000;
    std::vector<double> lengths;
    glm::dvec3 last = camera_at(path, 0).eye;
    std::vector<double> nearest(flight.points.size(), 1e9);
    double length = 0;
    for (int k = 1; k <= steps; ++k) {
        const Camera camera = camera_at(path, 12.0 * k / steps);
        lengths.push_back(glm::length(camera.eye - last));
        length += lengths.back();
        last = camera.eye;
        for (std::size_t i = 0; i < nearest.size(); ++i)
            nearest[i] = std::min(nearest[i], glm::length(camera.eye - flight.points[i]));
    }
    const auto [least, most] = std::minmax_element(lengths.begin(), lengths.end());
    EXPECT_LT(*most / (length / steps), 1.01);
    EXPECT_GT(*least / (length / steps), 0.99);
    for (std::size_t i = 1; i < nearest.size(); ++i)
        EXPECT_LT(nearest[i], 0.1) << "point " << i;
    EXPECT_EQ(camera_at(path, 0).eye, flight.points.front());
    EXPECT_EQ(camera_at(path, 12).eye, flight.points.back());
    EXPECT_THROW(fly_through({{{1, 2, 3}, {1, 2, 3}}}), Error);
}

TEST(CameraPath, RefusesInvalidPaths) {
    const CameraKey key{0, {0, -10, 0}, {0, 0, 0}};
    const auto refuses = [](const CameraPath& path, const std::string& what) {
        EXPECT_THAT([&] { camera_at(path, 0); }, ThrowsMessage<Error>(HasSubstr(what)));
    };
    refuses({}, "no keys");
    refuses({{key, key}}, "key 1 time: 0 s is not after");
    refuses({{key, {NAN, {1, 0, 0}, {0, 0, 0}}}}, "time: nan");
    refuses({{{0, {1, 2, 3}, {1, 2, 3}}}}, "key 0 target: (1, 2, 3) equals the eye");
    refuses({{{0, {1, 2, 3}, {0, 0, 0}, {0, 0, 0}}}}, "key 0 up");
    refuses({{{0, {1, 2, 3}, {0, 0, 0}, {0, 0, 1}, 180}}}, "180 is not between");
    refuses({{key, {1, {5, 0, 0}, {0, 0, 0}}}, true}, "loop");
}

TEST(CameraPath, ParametersAreExactAtTheirKeysAndMonotoneBetween) {
    const AnimatedParameter parameter{"iso_values[0]", {{0, -400}, {1, -400}, {2, 300}, {5, 310}, {6, 100}}};
    for (const auto& key : parameter.values)
        EXPECT_EQ(value_at(parameter, key.time), key.value);
    EXPECT_EQ(value_at(parameter, -3), -400);
    EXPECT_EQ(value_at(parameter, 99), 100);
    for (int k = 0; k < 600; ++k) {
        const double t = k / 100.0, a = value_at(parameter, t), b = value_at(parameter, t + 0.01);
        if (t < 1)
            EXPECT_EQ(a, -400);
        else if (t < 5)
            EXPECT_GE(b, a);
        else
            EXPECT_LE(b, a);
    }
    EXPECT_EQ(value_at({"x", {{1, 7}}}, 0), 7);
    EXPECT_THROW(value_at({"x", {}}, 0), Error);
    EXPECT_THROW(value_at({"x", {{1, 7}, {1, 8}}}, 0), Error);
    EXPECT_THROW(value_at({"x", {{1, NAN}}}, 0), Error);
}

}  // namespace
}  // namespace edgesplat
