// Warps and footprints at the limits of their parameters, where values vanish or overflow.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>

#include "footprints/footprint_integral.h"
#include "footprints/kernel.h"
#include "footprints/paper_warp.h"
#include "footprints/plane_face.h"

namespace edgesplat::test {
namespace {

constexpr double kReach = kKernelRadius;

TEST(FootprintLimits, PaperProfilesAtEveryLegalCorner) {
    constexpr double kTiny = 1e-6;
    int legal = 0;
    for (const double t1 : {kTiny, 0.2, 0.5 - kTiny}) {
        for (const double t2 : {0.5 + kTiny, 0.8, 1 - kTiny}) {
            const double least = t1 / 3, most = (2 + t2) / 3;
            const double pairs[][2] = {{least, most}, {least, least + kTiny}, {most - kTiny, most}, {0.5 - kTiny, 0.5}};
            for (const auto& m : pairs) {
                for (const PaperCurve curve : {PaperCurve::Cosine, PaperCurve::Smooth}) {
                    const PaperProfile profile{t1, t2, m[0], m[1], curve};
                    ASSERT_NO_THROW(validate(profile)) << t1 << " " << t2 << " " << m[0] << " " << m[1];
                    ++legal;
                    double before = -1;
                    for (int i = 0; i <= 400; ++i) {
                        const double x = i / 400.0, y = paper_profile(x, profile), inverse = paper_map(x, profile);
                        ASSERT_TRUE(std::isfinite(y) && std::isfinite(inverse));
                        ASSERT_GE(y, before - 1e-12) << "falls at " << x;
                        before = y;
                        ASSERT_GE(inverse, 0);
                        ASSERT_LE(inverse, 1);
                        // The inverse is accurate to 1e-13, however steep or flat p is.
                        ASSERT_LE(paper_profile(std::max(inverse - 1e-13, 0.0), profile), x + 1e-15);
                        ASSERT_GE(paper_profile(std::min(inverse + 1e-13, 1.0), profile), x - 1e-15);
                    }
                }
            }
        }
    }
    EXPECT_EQ(legal, 72);
}

TEST(FootprintLimits, PaperProfilesBeyondACornerAreRefused) {
    constexpr double kTiny = 1e-6;
    const PaperProfile beyond[] = {{0, 0.8, 0.45, 0.55},
                                   {0.2, 1, 0.45, 0.55},
                                   {0.5, 0.5, 0.45, 0.55},
                                   {0.2, 0.8, 0.2 / 3 - kTiny, 0.55},
                                   {0.2, 0.8, 0.45, (2 + 0.8) / 3 + kTiny},
                                   {0.2, 0.8, 0.5, 0.5},
                                   {0.2, 0.8, std::numeric_limits<double>::quiet_NaN(), 0.55}};
    for (const PaperProfile& profile : beyond)
        EXPECT_THROW(validate(profile), std::invalid_argument)
            << profile.t1 << " " << profile.t2 << " " << profile.m1 << " " << profile.m2;
}

TEST(FootprintLimits, PaperInversionWhereTheSlopeVanishes) {
    // p' = 0 at t1 and t2: Newton's method alone divides by 0 there. p is flat to second order, so p^-1 is only known
    // to the square root of p's accuracy.
    const PaperProfile profile;
    for (const double m : {profile.m1, profile.m2}) {
        const double t = m == profile.m1 ? profile.t1 : profile.t2;
        EXPECT_NEAR(paper_profile_slope(t, profile), 0, 1e-9);
        EXPECT_NEAR(paper_map(m, profile), t, 1e-6);
        double before = paper_map(m - 1e-3, profile);
        for (int i = -10; i <= 10; ++i) {
            const double at = paper_map(m + i * 1e-16, profile);
            EXPECT_TRUE(std::isfinite(at));
            EXPECT_GE(at, before - 1e-9);
            before = at;
        }
    }
}

/// Rays around a voxel: at every angle to the normal, also exactly parallel and perpendicular to it, and at every
/// distance.
template <typename Check>
void for_all_rays(const Check& check) {
    for (const double un : {-1.0, -1 + 1e-16, -0.7, -1e-9, 0.0, 1e-300, 0.3, 1 - 1e-9, 1.0}) {
        const double sine = std::sqrt(std::max(1 - un * un, 0.0));
        for (const double rho : {0.0, 1e-150, 1e-9, 0.8, kReach - 1e-12, kReach, kReach + 1e-12, 3.2, 1e6}) {
            for (const double turn : {-1.0, -0.5, 0.0, 1e-12, 1.0})
                check(Ray{rho * rho, rho * sine * turn, un});
        }
    }
}

TEST(FootprintLimits, FootprintsOfEveryRayAndDistanceAreBounded) {
    const double largest = kernel_footprint(0);
    for (const double d : {0.0, 1e-300, 0.3, 1.6, kReach + FACE_DEPTH, 1e3}) {
        for (const double side : {-1.0, 1.0}) {
            for_all_rays([&](const Ray& ray) {
                const PaperEdge edge{side * d, {}};
                const double warped = procedural_footprint(ray, edge), flat = warp2d_footprint(ray, edge);
                const double cut = FacePath(plane_face(ray, side * d), plane_cut(side * d)).footprint(5).integral;
                for (const double f : {warped, flat, cut}) {
                    ASSERT_TRUE(std::isfinite(f));
                    ASSERT_GE(f, 0);
                }
                // No footprint exceeds the kernel's maximum times the length of its support.
                ASSERT_LE(warped, kernel(0) * 2 * kPaperReach) << d << " " << ray.un;
                ASSERT_LE(cut, kernel(0) * 2 * (kReach + FACE_DEPTH)) << d << " " << ray.un;
                ASSERT_LE(flat, largest * (1 + 1e-12));
            });
        }
    }
}

TEST(FootprintLimits, EdgeOutOfReachChangesNothing) {
    for_all_rays([&](const Ray& ray) {
        const double plain = kernel_footprint(ray.rho2), reach = kReach + FACE_DEPTH;
        ASSERT_NEAR(procedural_footprint(ray, PaperEdge{kReach, {}}), plain, 1e-15);
        ASSERT_NEAR(FacePath(plane_face(ray, reach), plane_cut(reach)).footprint(32).integral, plain, 1e-6);
        ASSERT_EQ(FacePath(plane_face(ray, -reach), plane_cut(-reach)).footprint(5).integral, 0);
    });
}

TEST(FootprintLimits, ContinuousAcrossTheNormal) {
    const PaperEdge edge{0.4, {}};
    for (const double pn : {-0.6, 0.0, 0.3, 0.6, 0.9}) {
        const double across = exact_footprint({pn * pn + 0.04, pn, 0}, edge);
        for (const double un : {1e-300, 1e-16, 1e-12, 1e-8, -1e-8})
            EXPECT_NEAR(procedural_footprint({pn * pn + 0.04, pn, un}, edge), across, 3e-3 * kernel_footprint(0)) << un;
    }
}

TEST(FootprintLimits, ContinuousAlongTheNormal) {
    const PaperEdge edge{0.4, {}};
    for (const double rho : {0.0, 0.5, 1.2}) {
        const double along = exact_footprint({rho * rho, 0, 1}, edge);
        for (const double off : {1e-16, 1e-12, 1e-8}) {
            const double un = 1 - off;
            const double sine = std::sqrt(1 - un * un);
            EXPECT_NEAR(procedural_footprint({rho * rho, rho * sine, un}, edge), along, 3e-3 * kernel_footprint(0));
        }
    }
}

TEST(FootprintLimits, TheKernelEndsAtItsRadius) {
    const double r2 = kKernelRadius * kKernelRadius;
    EXPECT_EQ(kernel(r2), 0);
    EXPECT_EQ(kernel(1e300), 0);
    EXPECT_EQ(kernel(std::numeric_limits<double>::infinity()), 0);
    EXPECT_EQ(kernel_footprint(r2), 0);
    EXPECT_EQ(kernel_footprint(std::nextafter(r2, 10.0)), 0);
    EXPECT_GE(kernel_footprint(std::nextafter(r2, 0.0)), 0);
    EXPECT_EQ(kernel_footprint(1e300), 0);
    EXPECT_EQ(kernel_chord(r2, 5), 0);
    EXPECT_DOUBLE_EQ(kernel_chord(0, 1e300), kernel_footprint(0) / 2);
    EXPECT_DOUBLE_EQ(kernel_chord(0, -1e300), -kernel_footprint(0) / 2);
}

TEST(FootprintLimits, EmptyAndInfiniteSlices) {
    const PaperEdge edge{0.4, {}};
    constexpr double kInfinite = std::numeric_limits<double>::infinity();
    for_all_rays([&](const Ray& ray) {
        const double whole = procedural_footprint(ray, edge, 10);
        ASSERT_NEAR(procedural_footprint(ray, edge, 10, {-kInfinite, kInfinite}), whole, 1e-12);
        ASSERT_NEAR(procedural_footprint(ray, edge, 10, {-1e300, 1e300}), whole, 1e-12);
        ASSERT_NEAR(procedural_footprint(ray, edge, 10, {0.3, 0.3}), 0, 1e-12) << "a slice without thickness";
        ASSERT_NEAR(procedural_footprint(ray, edge, 10, {1e6, 1e7}), 0, 1e-12) << "a slice beyond the kernel";
        // Half-open slices add up to the whole, up to the quadrature error at the cut.
        const double halves = procedural_footprint(ray, edge, 10, {-kInfinite, 0.1}) +
                              procedural_footprint(ray, edge, 10, {0.1, kInfinite});
        ASSERT_NEAR(halves, whole, 5e-3 * kernel_footprint(0));
    });
}

}  // namespace
}  // namespace edgesplat::test
