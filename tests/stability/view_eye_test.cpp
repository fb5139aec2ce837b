// Difficult eye positions: on a voxel, in matter, at a surface, very far away; and difficult directions.
#include <algorithm>
#include <cmath>

#include "engine/reference/3_select_footprints.h"
#include "tests/stability/hazard.h"

namespace edgesplat::test {
namespace {

/// A torus that fills most of its grid, seen from `eye`.
Shot torus_from(const glm::dvec3& eye, const glm::dvec3& target, double fov, double extinction = 2) {
    static const auto volume =
        std::make_shared<const Volume>(sample(torus_scene({24, 24, 14}, {11.6, 11.3, 6.4}, 6.7, 3.2)));
    Shot shot = shot_of(volume, 0.5, extinction);
    shot.scene.lights = {Light{}};
    shot.camera = look(*volume, eye, target, fov);
    shot.width = shot.height = 28;
    return shot;
}

const glm::dvec3 kMiddle(11.6, 11.3, 6.4);
const glm::dvec3 kTube = kMiddle + glm::dvec3(0, -6.7, 0);  // on the ring, in the middle of the tube

void expect_like_the_reference(const Shot& shot, const std::string& what, double psnr = 58) {
    const ImageDifference difference = against_reference(shot, what);
    EXPECT_GE(difference.psnr, psnr) << what << ": largest " << difference.max << " at " << difference.x << ", "
                                     << difference.y;
}

TEST(ViewEye, OnAVoxelOfMatter) {
    for (const double extinction : {0.05, 2.0, 100.0})
        expect_like_the_reference(torus_from(glm::round(kTube), kMiddle, 70, extinction), "on a voxel");
}

TEST(ViewEye, OnAVoxelOfTheHole) {
    expect_like_the_reference(torus_from({12, 11, 6}, {12, 20, 6}, 90), "on a voxel of the hole");
}

TEST(ViewEye, BetweenEightVoxels) {
    expect_like_the_reference(torus_from(glm::round(kTube) + 0.5, kMiddle, 90, 0.3), "between voxels");
}

TEST(ViewEye, AtACornerAndOnAFaceOfTheGrid) {
    expect_like_the_reference(torus_from({0, 0, 0}, kMiddle, 60), "in the corner");
    expect_like_the_reference(torus_from({-0.5, 11, 6}, kMiddle, 60), "on the face");
}

TEST(ViewEye, InsideOpaqueMatterEveryPixelIsOpaque) {
    for (const double fov : {1.0, 60.0, 150.0}) {
        const Shot shot = torus_from(kTube + glm::dvec3(0.31, 0.2, -0.13), kMiddle, fov, 50);
        expect_like_the_reference(shot, "in matter");
        const Image color = sound(shot, "in matter").color;
        for (std::size_t i = 3; i < color.pixels.size(); i += 4)
            ASSERT_GT(color.pixels[i], 0.999F) << "there is a hole in matter";
    }
}

TEST(ViewEye, InsideAUniformBodyTheRestOfTheRayCounts) {
    // The matter ahead of the eye: from x = 8.3 to 19.5.
    const auto block = volume_of({20, 20, 20}, [](const glm::ivec3&) { return 1.0F; });
    Shot shot = shot_of(block, 0.5, 0.1);
    shot.width = shot.height = 16;
    for (const SheetCut sheets : {SheetCut::Whole, SheetCut::Sliced}) {
        shot.settings.sheets = sheets;
        for (const double x : {8.0, 8.25, 8.5, 8.3}) {
            shot.camera = look(*block, {x, 9.5, 9.5}, {19, 9.5, 9.5}, 2);
            const double got = middle_of(*sound(shot, "inside").tau, 0).mean;
            // With whole sheets, kernels that the eye's plane cuts are drawn completely or not at all.
            EXPECT_NEAR(got / 0.1, 19.5 - x, sheets == SheetCut::Sliced ? 0.01 : 0.6) << x;
        }
    }
}

TEST(ViewEye, AMillionthInFrontOfAndBehindASurface) {
    const glm::dvec3 surface = kTube - glm::dvec3(0, 3.2, 0);
    const Shot before = torus_from(surface - glm::dvec3(0, 1e-6, 0), kMiddle, 60, 20);
    const Shot behind = torus_from(surface + glm::dvec3(0, 1e-6, 0), kMiddle, 60, 20);
    expect_like_the_reference(before, "before the surface");
    expect_like_the_reference(behind, "behind the surface");
    EXPECT_GE(compare_images(render(before).color, render(behind).color).psnr, 50) << "a step of 2e-6 voxels";
}

TEST(ViewEye, AMillionVoxelsAway) {
    const glm::dvec3 way = glm::normalize(glm::dvec3(0.2, 1, -0.8));
    const auto from = [&](double distance) {
        return torus_from(kMiddle - distance * way, kMiddle, 2 * glm::degrees(std::atan(12 / distance)));
    };
    const Image near = sound(from(1e4), "1e4 voxels away").color;
    const Image far = sound(from(1e6), "1e6 voxels away").color;
    EXPECT_GT(middle_of(near, 3).most, 0.9);
    EXPECT_GE(compare_images(near, far).psnr, 38) << "both are nearly parallel projections";
    expect_like_the_reference(from(1e6), "1e6 voxels away", 50);
}

TEST(ViewEye, FieldOfViewOfOneDegree) {
    expect_like_the_reference(torus_from({11, -60, 25}, kMiddle, 1), "1 degree");
    expect_like_the_reference(torus_from({11, -600, 250}, kMiddle, 1), "1 degree from far away");
}

TEST(ViewEye, FieldOfViewOf170Degrees) {
    expect_like_the_reference(torus_from({11, -5, 9}, kMiddle, 170), "170 degrees");
    expect_like_the_reference(torus_from({12, 11, 6}, {12, 20, 6}, 170), "170 degrees in the hole");
}

TEST(ViewEye, FieldOfViewOf179Degrees) {
    expect_like_the_reference(torus_from({12, 11, 6}, {12, 20, 6}, 179.9), "179.9 degrees in the hole");
}

/// A ball in the middle of its grid, seen along `way`: the same from all six sides and along all diagonals.
Image ball_along(const glm::dvec3& way, const glm::dvec3& up, double extinction = 0.2) {
    static const auto ball = std::make_shared<const Volume>(sample(sphere_scene({17, 17, 17}, {8, 8, 8}, 5.23)));
    Shot shot = shot_of(ball, 0.5, extinction);
    shot.camera =
        look(*ball,
             glm::dvec3(8) - 60.0 * glm::normalize(way / std::max({std::abs(way.x), std::abs(way.y), std::abs(way.z)})),
             {8, 8, 8}, 16, up);
    shot.camera.direction = way;
    shot.width = shot.height = 31;
    EXPECT_GE(against_reference(shot, "a ball").psnr, 60);
    return render(shot).color;
}

TEST(ViewEye, AlongEveryGridAxisTheSame) {
    const Image want = ball_along({1, 0, 0}, {0, 0, 1});
    EXPECT_GT(middle_of(want, 3).mean, 0.5);
    const glm::dvec3 ways[] = {{-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
    for (const glm::dvec3& way : ways)
        EXPECT_LE(
            compare_images(want, ball_along(way, std::abs(way.z) > 0 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 0, 1))).max,
            2e-4)
            << way.x << " " << way.y << " " << way.z;
}

TEST(ViewEye, AlongEveryDiagonalTheSame) {
    const Image want = ball_along({1, 1, 0}, {0, 0, 1});
    EXPECT_LE(compare_images(want, ball_along({1, -1, 0}, {0, 0, 1})).max, 2e-4);
    EXPECT_LE(compare_images(want, ball_along({0, 1, 1}, {1, 0, 0})).max, 2e-4);
    const Image space = ball_along({1, 1, 1}, {0, 0, 1});
    EXPECT_LE(compare_images(space, ball_along({-1, -1, 1}, {0, 0, 1})).max, 2e-4);
}

TEST(ViewEye, AnUlpOffAGridAxis) {
    const Image on = ball_along({1, 0, 0}, {0, 0, 1});
    const double tiny[] = {5e-324, 1e-300, 2.3e-16, 1e-12, 1e-9};
    for (const double off : tiny) {
        EXPECT_LE(compare_images(on, ball_along({1, off, 0}, {0, 0, 1})).max, 2e-4) << off;
        EXPECT_LE(compare_images(on, ball_along({1, -off, off}, {0, 0, 1})).max, 2e-4) << off;
    }
}

TEST(ViewEye, AnUlpOffADiagonal) {
    const Image on = ball_along({1, 1, 1}, {0, 0, 1});
    EXPECT_LE(compare_images(on, ball_along({1, std::nextafter(1.0, 2.0), 1}, {0, 0, 1})).max, 2e-4);
    EXPECT_LE(compare_images(on, ball_along({1, 1, std::nextafter(1.0, 0.0)}, {0, 0, 1})).max, 2e-4);
}

TEST(ViewEye, DirectionsOfAnyLength) {
    const Image want = ball_along({1, 0.3, 0.2}, {0, 0, 1});
    for (const double length : {1e-300, 1e-6, 1e6, 1e300})
        EXPECT_LE(compare_images(want, ball_along(length * glm::dvec3(1, 0.3, 0.2), glm::dvec3(0, 0, length))).max,
                  1e-5)
            << length;
}

TEST(ViewEye, UpParallelToTheView) {
    // Replaced by the world axis least parallel to the view.
    EXPECT_EQ(ball_along({0, 0, 1}, {0, 0, 1}).pixels, ball_along({0, 0, 1}, {1, 0, 0}).pixels);
    EXPECT_EQ(ball_along({0, 0, 1}, {0, 0, -1e-6}).pixels, ball_along({0, 0, 1}, {1, 0, 0}).pixels);
}

TEST(ViewEye, UpNearlyParallelToTheView) {
    for (const double off : {1e-2, 1e-4, 2e-6}) {
        const CameraFrame frame = camera_frame({.direction = {0, 0, 1}, .up = {0, off, 1}});
        EXPECT_NEAR(frame.up.y, 1, 1e-6) << off;
        EXPECT_NEAR(glm::length(frame.right), 1, 1e-12);
        EXPECT_NEAR(glm::dot(frame.right, frame.forward), 0, 1e-12);
        EXPECT_LE(compare_images(ball_along({0, 0, 1}, {0, off, 1}), ball_along({0, 0, 1}, {0, 1, 0})).max, 2e-4)
            << off;
    }
    // Below an angle of a millionth, `up` has no reliable direction, and counts as parallel.
    for (const double off : {5e-7, 1e-9, 1e-300})
        EXPECT_EQ(ball_along({0, 0, 1}, {0, off, 1}).pixels, ball_along({0, 0, 1}, {0, 0, 1}).pixels) << off;
}

}  // namespace
}  // namespace edgesplat::test
