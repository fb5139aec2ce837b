#include "footprints/paper_warp.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

#include "footprints/kernel.h"

namespace edgesplat {
namespace {

using testing::HasSubstr;
using testing::ThrowsMessage;

const PaperProfile kProfiles[] = {{0.2, 0.7, 0.3, 0.45},
                                  {0.1, 0.9, 0.45, 0.52},
                                  {0.3, 0.6, 0.1, 0.86},
                                  {0.2, 0.7, 0.3, 0.45, PaperCurve::Smooth},
                                  {0.1, 0.9, 0.45, 0.52, PaperCurve::Smooth}};

TEST(PaperProfile, MeetsItsBoundaryConditions) {
    for (const PaperProfile& q : kProfiles) {
        ASSERT_NO_THROW(validate(q));
        EXPECT_NEAR(paper_profile(q.t1, q), q.m1, 1e-14);
        EXPECT_NEAR(paper_profile(q.t2, q), q.m2, 1e-14);
        EXPECT_NEAR(paper_profile(1e-9, q), 1e-9, 1e-15);
        EXPECT_NEAR(1 - paper_profile(1 - 1e-9, q), 1e-9, 1e-14);
        if (q.curve == PaperCurve::Smooth) continue;
        EXPECT_NEAR(paper_profile_slope(1e-12, q), 1, 1e-9);
        EXPECT_NEAR(paper_profile_slope(1 - 1e-12, q), 1, 1e-9);
        EXPECT_NEAR(paper_profile_slope(q.t1, q), 0, 1e-9);
        EXPECT_NEAR(paper_profile_slope(q.t2, q), 0, 1e-9);
        EXPECT_NEAR(paper_profile(0.5 * (q.t1 + q.t2), q), 0.5 * (q.m1 + q.m2), 1e-15);
    }
}

TEST(PaperProfile, IsMonotoneAndInvertedExactly) {
    for (const PaperProfile& q : kProfiles)
        for (int i = 1; i < 1000; ++i) {
            const double x = i / 1000.0;
            EXPECT_GT(paper_profile(x, q), paper_profile(x - 0.001, q));
            EXPECT_NEAR(paper_profile(paper_map(x, q), q), x, 1e-13) << x;
            const double h = 1e-6, slope = (paper_profile(x + h, q) - paper_profile(x - h, q)) / (2 * h);
            EXPECT_NEAR(paper_profile_slope(x, q), slope, 2e-3 * (1 + slope)) << x;
        }
    EXPECT_EQ(paper_map(-0.5, kProfiles[0]), -0.5);
    EXPECT_EQ(paper_map(1.5, kProfiles[0]), 1.5);
}

TEST(PaperProfile, RefusesNonMonotoneProfiles) {
    EXPECT_THAT(
        [] {
            validate({0.6, 0.8, 0.1, 0.5});
        },
        ThrowsMessage<std::invalid_argument>(HasSubstr("m1 = 0.1 must be at least t1/3 = 0.2")));
    EXPECT_THAT([] { validate({0.1, 0.4, 0.3, 0.95}); }, ThrowsMessage<std::invalid_argument>(HasSubstr("m2 = 0.95")));
    EXPECT_THAT([] { validate({0.5, 0.4, 0.3, 0.6}); }, ThrowsMessage<std::invalid_argument>(HasSubstr("t2 = 0.4")));
    EXPECT_THAT([] { validate({0.0, 0.4, 0.3, 0.6}); }, ThrowsMessage<std::invalid_argument>(HasSubstr("t1 = 0")));
    EXPECT_THAT([] { validate({0.2, 0.8, 0.5, 0.5}); }, ThrowsMessage<std::invalid_argument>(HasSubstr("m2 = 0.5")));
    // Beyond the limit p is not monotone.
    const PaperProfile bad = {0.6, 0.8, 0.1, 0.5};
    EXPECT_LT(paper_profile(0.55, bad), paper_profile(0.3, bad));
}

TEST(PaperWarp, SamplesEdgeHalfwayBetweenVoxels) {
    for (PaperCurve curve : {PaperCurve::Cosine, PaperCurve::Smooth})
        for (double d = 0.15; d <= 0.85; d += 0.05) {
            const PaperShape shape = {0.3, 0.05, curve};
            EXPECT_NEAR(warped_coordinate(d, PaperEdge{d, shape}), 0.5, 1e-12);
            EXPECT_NEAR(warped_coordinate(1 + d, PaperEdge{1 + d, shape}), d < 0.6 ? 1.5 : 1 + d, 1e-12);
        }
}

TEST(PaperWarp, BothSidesOfAnEdgeShareOneCurve) {
    // Four cases with an edge at 0.3: primary and secondary splats at 0 and -1 on one side, at 1 and 2 on the other.
    const double edge = 0.3;
    for (double x = 0; x <= 1; x += 0.01) {
        const double position = warped_coordinate(x, PaperEdge{edge, {}});
        EXPECT_NEAR(warped_coordinate(x + 1, PaperEdge{edge + 1, {}}) - 1, position, 1e-6);
        EXPECT_NEAR(1 - warped_coordinate(1 - x, PaperEdge{1 - edge, {}}), position, 1e-6);
        // The secondary splat on the other side is 1.7 from the edge, beyond the kernel's radius, so it has no edge.
        EXPECT_EQ(warped_coordinate(2 - x, PaperEdge{2 - edge, {}}), 2 - x);
    }
}

TEST(PaperWarp, EveryDistanceGivesValidProfile) {
    for (double d = -1; d < 2; d += 0.01)
        EXPECT_NO_THROW(validate(paper_profile_for({d, {}}))) << d;
    EXPECT_EQ(warped_coordinate(1.3, PaperEdge{kKernelRadius, {}}), 1.3);
}

}  // namespace
}  // namespace edgesplat
