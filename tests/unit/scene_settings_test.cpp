// Validation of cameras, scenes and settings, and its messages.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <string>

#include "engine/error.h"
#include "engine/scene/camera.h"
#include "engine/scene/scene.h"
#include "engine/scene/settings.h"
#include "tests/unit/refusal.h"

namespace edgesplat {
namespace {

using testing::AllOf;
using testing::HasSubstr;

const double kNan = std::numeric_limits<double>::quiet_NaN();

Scene good_scene() {
    Scene scene;
    scene.iso_values = {1, 2};
    scene.materials.resize(3);
    return scene;
}

TEST(Scene, AcceptsValidScene) {
    EXPECT_NO_THROW(validate(good_scene()));
}

TEST(Scene, NamesInvalidField) {
    const auto with = [](const std::function<void(Scene&)>& change) {
        return refusal([&] {
            Scene scene = good_scene();
            change(scene);
            validate(scene);
        });
    };
    EXPECT_THAT(with([](Scene& s) { s.iso_values.clear(); }), AllOf(HasSubstr("iso_values"), HasSubstr("1 to 15")));
    EXPECT_THAT(with([](Scene& s) { s.iso_values.assign(16, 0); }), HasSubstr("16"));
    EXPECT_THAT(with([](Scene& s) { s.iso_values = {2, 2}; }), HasSubstr("iso_values[1]"));
    EXPECT_THAT(with([](Scene& s) { s.iso_values = {kNan, 2}; }), HasSubstr("iso_values[0]"));
    EXPECT_THAT(with([](Scene& s) { s.materials.pop_back(); }), AllOf(HasSubstr("materials"), HasSubstr("3")));
    EXPECT_THAT(with([](Scene& s) { s.materials[2].extinction = -1; }), HasSubstr("materials[2].extinction"));
    EXPECT_THAT(with([](Scene& s) { s.materials[1].extinction = kNan; }), HasSubstr("materials[1].extinction"));
    EXPECT_THAT(with([](Scene& s) { s.materials[0].color.y = 1.5; }), HasSubstr("materials[0].color"));
    EXPECT_THAT(with([](Scene& s) { s.background.x = kNan; }), HasSubstr("background"));
    EXPECT_THAT(with([](Scene& s) { s.lights.front().intensity = kNan; }), HasSubstr("intensity"));
    EXPECT_THAT(with([](Scene& s) { s.lights = {directional_light(glm::dvec3(0))}; }), HasSubstr("direction"));
}

TEST(Settings, NamesInvalidField) {
    const auto with = [](const std::function<void(Settings&)>& change) {
        return refusal([&] {
            Settings settings;
            change(settings);
            validate(settings);
        });
    };
    EXPECT_NO_THROW(validate(Settings{}));
    for (const double bad : {0.0, 16.1, kNan}) {
        EXPECT_THAT(with([&](Settings& s) { s.sheet_spacing = bad; }),
                    AllOf(HasSubstr("sheet_spacing"), HasSubstr("[0.05, 16]")));
    }
    EXPECT_THAT(with([](Settings& s) { s.saturation = 0; }), HasSubstr("saturation"));
    EXPECT_THAT(with([](Settings& s) { s.saturation = kNan; }), HasSubstr("saturation"));
}

TEST(Settings, NamesRoundTrip) {
    for (const auto name : edge_estimator_names())
        EXPECT_EQ(name_of(edge_estimator_named(name)), name);
    for (const auto name : footprint_mode_names())
        EXPECT_EQ(name_of(footprint_mode_named(name)), name);
    for (const auto name : warp_family_names())
        EXPECT_EQ(name_of(warp_family_named(name)), name);
    for (const auto name : sheet_format_names())
        EXPECT_EQ(name_of(sheet_format_named(name)), name);
    EXPECT_EQ(footprint_mode_named("warp2d"), FootprintMode::Warp2d);
    EXPECT_THAT(refusal([] { edge_estimator_named("sobel"); }), AllOf(HasSubstr("sobel"), HasSubstr("march")));
}

TEST(Camera, FrameIsOrthonormalAndRightHanded) {
    for (const glm::dvec3 direction :
         {glm::dvec3(0, 1, 0), glm::dvec3(0, 0, -3), glm::dvec3(1e-200, 2e-200, 0), glm::dvec3(1e200, -1e200, 1e200)}) {
        Camera camera;
        camera.direction = direction;
        const CameraFrame f = camera_frame(camera);
        EXPECT_NEAR(glm::length(f.right), 1, 1e-12);
        EXPECT_NEAR(glm::length(f.up), 1, 1e-12);
        EXPECT_NEAR(glm::length(f.forward), 1, 1e-12);
        EXPECT_NEAR(glm::length(glm::cross(f.right, f.up) + f.forward), 0, 1e-12);
    }
}

TEST(Camera, LooksAlongYByDefault) {
    const CameraFrame f = camera_frame({});
    EXPECT_NEAR(glm::length(f.right - glm::dvec3(1, 0, 0)), 0, 1e-12);
    EXPECT_NEAR(glm::length(f.up - glm::dvec3(0, 0, 1)), 0, 1e-12);
    EXPECT_NEAR(f.tan_half_y, std::tan(glm::radians(22.5)), 1e-12);
}

TEST(Camera, RefusesDegenerateCameras) {
    Camera camera;
    camera.direction = {0, 0, 0};
    EXPECT_THAT(refusal([&] { camera_frame(camera); }), HasSubstr("direction"));
    camera = {};
    camera.fov_y = 180;
    EXPECT_THAT(refusal([&] { camera_frame(camera); }), HasSubstr("fov_y"));
    camera.fov_y = kNan;
    EXPECT_THAT(refusal([&] { camera_frame(camera); }), HasSubstr("fov_y"));
    camera = {};
    camera.eye.x = kNan;
    EXPECT_THAT(refusal([&] { camera_frame(camera); }), HasSubstr("eye"));
}

}  // namespace
}  // namespace edgesplat
