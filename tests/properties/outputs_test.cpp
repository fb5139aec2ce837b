// Depth, normal and edge distance of a plane at a known position.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/properties/scenes.h"

namespace edgesplat::test {
namespace {

/// An opaque half space seen face-on from `distance` voxels in front of its surface; also on an anisotropic grid.
struct FaceOn {
    Shot shot;
    glm::dvec3 normal_world;
    double distance;  ///< mm along the view axis
};

FaceOn face_on(const Pose& pose, const glm::dvec3& spacing) {
    constexpr int kSize = 24;
    const glm::dvec3 center = glm::dvec3((kSize - 1) / 2.0) + pose.shift;
    const glm::dmat3 axes(glm::dvec3(spacing.x, 0, 0), glm::dvec3(0, spacing.y, 0), glm::dvec3(0, 0, spacing.z));
    FaceOn f;
    f.shot.volume = sampled(
        glm::ivec3(kSize), [&](const glm::dvec3& x) { return blurred_step(glm::dot(pose.n, x - center)); }, axes);
    f.shot.scene = two_tone(0, 4 / std::min({spacing.x, spacing.y, spacing.z}));
    f.shot.scene.lights = {Light{}};
    f.normal_world = glm::normalize(glm::inverse(glm::transpose(axes)) * pose.n);
    f.distance = 60;
    f.shot.camera.eye = axes * center + f.distance * f.normal_world;
    f.shot.camera.direction = -f.normal_world;
    f.shot.camera.fov_y = 6;
    f.shot.width = f.shot.height = 32;
    return f;
}

TEST(Outputs, AreRightForAPlaneThatFacesTheCamera) {
    for (const glm::dvec3& spacing : {glm::dvec3(1), glm::dvec3(0.6, 1.0, 1.4)}) {
        for (const Pose& pose : poses(8)) {
            const FaceOn f = face_on(pose, spacing);
            const RenderResult r = render(f.shot, {.depth = true, .normal = true, .distance = true});
            double widest = 0, farthest = 0;
            for (int y = 0; y < 32; ++y) {
                for (int x = 0; x < 32; ++x) {
                    ASSERT_GT(r.color.at(x, y, 3), 0.95F);
                    farthest = std::max(farthest, std::abs(static_cast<double>(r.depth->at(x, y, 0)) - f.distance));
                    const glm::dvec3 n(r.normal->at(x, y, 0), r.normal->at(x, y, 1), r.normal->at(x, y, 2));
                    EXPECT_NEAR(glm::length(n), 1, 1e-3);
                    widest = std::max(
                        widest, glm::degrees(std::acos(std::min(glm::dot(glm::normalize(n), f.normal_world), 1.0))));
                    const float d = r.distance->at(x, y, 0);
                    EXPECT_TRUE(std::isfinite(d));
                    EXPECT_LT(d, 0.1F) << "the visible voxels are inside";
                    EXPECT_GT(d, -2.0F) << "and next to the edge";
                }
            }
            const double voxel = std::max({spacing.x, spacing.y, spacing.z});
            EXPECT_LE(farthest, voxel) << "depth, mm";
            EXPECT_LE(widest, 2) << "normal, degrees";
        }
    }
}

TEST(Outputs, AreZeroWhereNothingIsHit) {
    Shot shot = torus_shot();
    shot.camera.direction = -shot.camera.direction;
    const RenderResult r = render(shot, {.tau = true, .depth = true, .normal = true, .distance = true});
    for (const Image* image : {&*r.tau, &*r.depth, &*r.normal, &*r.distance})
        EXPECT_TRUE(within(*image, 0, 0));
}

TEST(Outputs, DoNotChangeThePicture) {
    const Shot shot = torus_shot();
    const Image alone = render(shot).color;
    EXPECT_EQ(alone.pixels, render(shot, {.tau = true, .depth = true, .normal = true, .distance = true}).color.pixels);
    EXPECT_EQ(alone.pixels, render(shot).color.pixels) << "the next frame is the same again";
}

}  // namespace
}  // namespace edgesplat::test
