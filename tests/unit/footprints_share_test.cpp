// How much of a kernel matter holds, against sums over a fine grid.
#include <gtest/gtest.h>

#include <functional>
#include <glm/glm.hpp>

#include "footprints/face.h"
#include "footprints/face_share.h"
#include "footprints/kernel.h"

namespace edgesplat {
namespace {

/// The integral of the kernel about (0, 0, -depth) over where `matter` holds; the foot point is 0, n is z.
double held(double depth, const std::function<bool(const glm::dvec3&)>& matter) {
    constexpr int kSteps = 64;
    constexpr double kStep = 2 * kKernelRadius / kSteps;
    double sum = 0;
    for (int i = 0; i < kSteps * kSteps * kSteps; ++i) {
        const glm::dvec3 cell(i % kSteps, i / kSteps % kSteps, i / (kSteps * kSteps));
        const glm::dvec3 r = kStep * (cell + 0.5) - kKernelRadius;
        if (matter(r - glm::dvec3(0, 0, depth))) sum += kernel(glm::dot(r, r));
    }
    return sum * kStep * kStep * kStep;
}

TEST(FaceShare, ThickMatterHoldsAll) {
    EXPECT_NEAR(face_share({}, kDeepFaceDepth), 1, 1e-4);
    EXPECT_NEAR(face_share({.bend = 0.1, .mean = 0.1}, kDeepFaceDepth), 1, 2e-3);
    EXPECT_NEAR(face_share({.thickness = 2 * kDeepFaceDepth}, kDeepFaceDepth), 1, 0.03);
}

TEST(FaceShare, OfPlates) {
    for (const double thickness : {0.5, 1.0, 1.5, 2.0, 2.5}) {
        const double depth = 0.5 * thickness;
        const double want = held(depth, [&](const glm::dvec3& x) { return x.z < 0 && x.z > -thickness; });
        EXPECT_NEAR(face_share({.thickness = thickness}, depth), std::max(want, kernel(0)), 0.003) << thickness;
    }
}

TEST(FaceShare, OfBalls) {
    for (const double radius : {0.8, 1.0, 1.5, 2.0, 3.0}) {
        const double depth = std::min(kDeepFaceDepth, 0.5 * radius);
        const double want = held(depth, [&](const glm::dvec3& x) {
            return glm::dot(x + glm::dvec3(0, 0, radius), x + glm::dvec3(0, 0, radius)) < radius * radius;
        });
        EXPECT_NEAR(face_share({.bend = 1 / radius, .mean = 1 / radius}, depth), std::max(want, kernel(0)), 0.02)
            << radius;
    }
}

TEST(FaceShare, OfRods) {
    for (const double radius : {0.8, 1.0, 1.5, 2.0}) {
        const double depth = std::min(kDeepFaceDepth, 0.5 * radius);
        const double want = held(
            depth, [&](const glm::dvec3& x) { return x.x * x.x + (x.z + radius) * (x.z + radius) < radius * radius; });
        const FaceBody rod{.bend = 1 / radius, .mean = 0.5 / radius, .spread = 0.5 / radius};
        EXPECT_NEAR(face_share(rod, depth), std::max(want, kernel(0)), 0.03) << radius;
    }
}

TEST(FaceShare, SaddlesHoldAsMuchAsPlanes) {
    EXPECT_NEAR(face_share({.spread = 0.3}, 0.8), face_share({}, 0.8), 0.01);
}

TEST(FaceShare, AVoxelHasItsOwnMatter) {
    EXPECT_DOUBLE_EQ(face_share({.bend = 4, .mean = 4}, 0.125), kernel(0));
    EXPECT_DOUBLE_EQ(face_share({.thickness = 0.2}, 0.1), kernel(0));
}

}  // namespace
}  // namespace edgesplat
