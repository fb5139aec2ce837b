// Warps and footprints at the corners of what is legal, where something is about to vanish or to overflow.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>

#include "footprints/edge_warp.h"
#include "footprints/edge_weight.h"
#include "footprints/footprint_integral.h"
#include "footprints/footprint_table.h"
#include "footprints/kernel.h"
#include "footprints/paper_warp.h"

namespace edgesplat::test {
namespace {

constexpr double kReach = kKernelRadius;

/// Bands at the ends of what is legal: a in (0, 3], k in [1, 64].
const EdgeBand kBands[] = {{1e-6, 1}, {1e-6, 64}, {0.05, 64}, {1.6, 1}, {1.6, 1 + 1e-9}, {1.6, 64}, {3, 1}, {3, 64}};

TEST(FootprintLimits, WarpsOfEveryLegalBandAreMonotoneAndInvert) {
    for (const EdgeBand& band : kBands) {
        double before = -std::numeric_limits<double>::infinity();
        for (int i = -4000; i <= 4000; ++i) {
            const double s = i * 1e-3 * std::max(band.half_width, 1e-3);
            const double w = edge_warp(s, band);
            ASSERT_TRUE(std::isfinite(w));
            ASSERT_GT(w, before) << s << ", a " << band.half_width << ", k " << band.strength;
            before = w;
            ASSERT_NEAR(edge_warp_inverse(w, band), s, 1e-12 * std::max(1.0, band.strength)) << s;
            const double slope = edge_warp_slope(s, band);
            // The slope's mean over the band is 1: below it somewhere, and never 0.
            ASSERT_GT(slope, 0);
            ASSERT_LE(slope, band.strength * (1 + 1e-12));
        }
    }
}

TEST(FootprintLimits, WarpsJoinTheIdentityWhereTheBandEnds) {
    for (const EdgeBand& band : kBands) {
        for (const double side : {-1.0, 1.0}) {
            const double a = side * band.half_width;
            EXPECT_DOUBLE_EQ(edge_warp(a, band), a);
            EXPECT_NEAR(edge_warp(std::nextafter(a, 0.0), band), a, 1e-14);
            EXPECT_DOUBLE_EQ(edge_warp(std::nextafter(a, 10 * a), band), std::nextafter(a, 10 * a));
            EXPECT_NEAR(edge_warp_slope(a, band), 1, 1e-9);
        }
        EXPECT_EQ(edge_warp(0, band), 0);
        EXPECT_NEAR(edge_warp_slope(0, band), band.strength, 1e-9 * band.strength);
    }
}

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
                        // Within 1e-13 of the place, however steep or flat p is there.
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

TEST(FootprintLimits, ThePapersInversionWhereItsSlopeVanishes) {
    // p' = 0 at t1 and t2: Newton alone divides by nothing there. p is flat to second order, so p^-1 is known to the
    // root of what p is.
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

/// Rays around a voxel: at every angle to the normal, also exactly along and across it, and at every distance.
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

TEST(FootprintLimits, FootprintsOfEveryBandRayAndDistanceAreBounded) {
    const double largest = kernel_footprint(0);
    for (const EdgeBand& band : kBands) {
        for (const double d : {0.0, 1e-300, 0.3, 1.6, kReach + band.half_width, 1e3}) {
            for (const double side : {-1.0, 1.0}) {
                for_all_rays([&](const Ray& ray) {
                    const Edge edge{.distance = side * d, .band = band};
                    const double f = procedural_footprint(ray, edge);
                    ASSERT_TRUE(std::isfinite(f));
                    ASSERT_GE(f, 0);
                    // A warped kernel is nowhere larger than the kernel, and its support no longer than 2 (R + a).
                    ASSERT_LE(f, kernel(0) * 2 * (kReach + band.half_width)) << d << " " << ray.un;
                    const double flat = warp2d_footprint(ray, edge);
                    ASSERT_TRUE(std::isfinite(flat));
                    ASSERT_GE(flat, 0);
                    ASSERT_LE(flat, largest * (1 + 1e-12));
                });
            }
        }
    }
}

TEST(FootprintLimits, AnEdgeOutOfReachIsNone) {
    for (const EdgeBand& band : kBands) {
        const double reach = kReach + band.half_width;
        for (const double side : {-1.0, 1.0}) {
            for_all_rays([&](const Ray& ray) {
                const double plain = kernel_footprint(ray.rho2);
                ASSERT_NEAR(procedural_footprint(ray, Edge{.distance = side * reach, .band = band}), plain, 1e-15);
                // Half a step nearer it is still nearly none: the kernel and the warp both end smoothly.
                const Edge just_in{.distance = side * (reach - 1e-6), .band = band};
                ASSERT_NEAR(procedural_footprint(ray, just_in), plain, 1e-8);
            });
        }
    }
}

TEST(FootprintLimits, ContinuousWhereTheRayLiesAcrossTheNormal) {
    const Edge edge{.distance = 0.4, .band = {}};
    for (const double pn : {-0.6, 0.0, 0.399, 0.401, 0.9}) {
        const double across = exact_footprint({pn * pn + 0.04, pn, 0}, edge);
        for (const double un : {1e-300, 1e-16, 1e-12, 1e-8, -1e-8})
            EXPECT_NEAR(procedural_footprint({pn * pn + 0.04, pn, un}, edge), across, 3e-3 * kernel_footprint(0)) << un;
    }
}

TEST(FootprintLimits, ContinuousWhereTheRayLiesAlongTheNormal) {
    const Edge edge{.distance = 0.4, .band = {}};
    for (const double rho : {0.0, 0.5, 1.2}) {
        const double along = exact_footprint({rho * rho, 0, 1}, edge);
        for (const double off : {1e-16, 1e-12, 1e-8}) {
            const double un = 1 - off;
            const double sine = std::sqrt(1 - un * un);
            EXPECT_NEAR(procedural_footprint({rho * rho, rho * sine, un}, edge), along, 3e-3 * kernel_footprint(0));
        }
    }
}

TEST(FootprintLimits, WallsWithoutThickness) {
    for (const double thickness : {0.0, 1e-300, 1e-9, 0.5, 1.0, 1 + 1e-9, 2.0}) {
        for (const double d : {0.0, 0.2, 1.0}) {
            const Edge wall = wall_edge(d, thickness - d, {});
            EXPECT_TRUE(std::isfinite(wall.band.half_width) && std::isfinite(wall.band.strength));
            EXPECT_GE(wall.band.strength, 1);
            for_all_rays([&](const Ray& ray) {
                const double f = procedural_footprint(ray, wall);
                ASSERT_TRUE(std::isfinite(f)) << thickness;
                ASSERT_GE(f, 0);
                ASSERT_LE(f, kernel(0) * 2 * (kReach + wall.band.half_width));
                if (thickness > 1) return;
                // Not warped any more, up to the rule's own error.
                ASSERT_NEAR(f, kernel_footprint(ray.rho2), 1e-5 * kernel_footprint(0)) << thickness;
            });
        }
    }
}

TEST(FootprintLimits, EdgesAsCurvedAsTheyMayBe) {
    for (const double sign : {-1.0, 1.0}) {
        for (const double d : {-0.5, 0.0, 0.7, 1.6}) {
            const EdgeBand band{1.6, 16};
            const Edge edge{.distance = d, .band = band, .curvature = sign * (1 - 1e-9) / band.half_width};
            for_all_rays([&](const Ray& ray) {
                const double f = procedural_footprint(ray, edge);
                ASSERT_TRUE(std::isfinite(f));
                ASSERT_GE(f, 0);
                ASSERT_LE(f, kernel(0) * 2 * (kReach + band.half_width));
            });
        }
    }
}

TEST(FootprintLimits, HalfFloatsRoundOverflowAndVanishAsIeeeSays) {
    EXPECT_EQ(half_from_float(65504.0F), 0x7bff);
    EXPECT_EQ(half_from_float(65519.996F), 0x7bff) << "below half a step above the largest";
    EXPECT_EQ(half_from_float(65520.0F), 0x7c00) << "infinity";
    EXPECT_EQ(half_from_float(3e38F), 0x7c00);
    EXPECT_EQ(half_from_float(-3e38F), 0xfc00);
    EXPECT_EQ(half_from_float(5.9604645e-8F), 0x0001) << "the smallest";
    EXPECT_EQ(half_from_float(2.9802322e-8F), 0x0000) << "half of it goes to the even neighbour";
    EXPECT_EQ(half_from_float(2.99e-8F), 0x0001);
    EXPECT_EQ(half_from_float(1e-45F), 0x0000);
    EXPECT_EQ(half_from_float(-0.0F), 0x8000);
    EXPECT_EQ(half_from_float(6.1035156e-5F), 0x0400) << "the smallest normal";
    for (std::uint32_t h = 0; h < 0x7c00; ++h)
        ASSERT_EQ(half_from_float(float_from_half(static_cast<std::uint16_t>(h))), h);
}

/// Built once: 20 x 10 x 9 x 7 texels.
const FootprintTable& small_table() {
    static const FootprintTable table = FootprintTable::build({}, {20, 10, 9, 7});
    return table;
}

TEST(FootprintLimits, TableTexelsAreNeitherLostNorOverflown) {
    for (const EdgeBand& band : {EdgeBand{1.6, 16}, EdgeBand{0.05, 64}, EdgeBand{3, 64}}) {
        const FootprintTable table = FootprintTable::build(band, {20, 10, 9, 7});
        float largest = 0;
        for (const std::uint16_t texel : table.texels()) {
            const float value = float_from_half(texel);
            ASSERT_TRUE(std::isfinite(value));
            largest = std::max(largest, std::abs(value));
        }
        EXPECT_LT(static_cast<double>(largest), 2 * kernel_footprint(0))
            << "a correction, not more than what it corrects";
        // What is below the smallest normal half is nothing next to g(0): an underflow is seen by nobody.
        EXPECT_LT(6.2e-5, 1e-3 * kernel_footprint(0));
    }
}

TEST(FootprintLimits, TablesGoOnAcrossTheBordersOfTheirLayers) {
    const FootprintTable& table = small_table();
    const double step = (kReach + table.band().half_width) / (table.size().distances - 1);
    for (int layer = 0; layer < table.size().distances; ++layer) {
        for (const double un : {0.0, 0.4, 1.0}) {
            const Ray ray{0.49, 0.3 * std::sqrt(1 - un * un), un};
            const double at = layer * step;
            const double before = table.lerp(ray, at - 1e-9), after = table.lerp(ray, at + 1e-9);
            EXPECT_NEAR(before, after, 1e-6) << layer;
            EXPECT_NEAR(table.lerp(ray, at), after, 1e-6) << layer;
            EXPECT_TRUE(std::isfinite(table.nearest(ray, at)));
        }
    }
    // Beyond the last layer: the plain footprint, and no jump on the way there.
    const Ray ray{0.49, 0.3, 0.2};
    const double reach = kReach + table.band().half_width;
    EXPECT_NEAR(table.lerp(ray, reach - 1e-9), kernel_footprint(0.49), 1e-4);
    EXPECT_DOUBLE_EQ(table.lerp(ray, reach), kernel_footprint(0.49));
    EXPECT_DOUBLE_EQ(table.lerp(ray, -reach), kernel_footprint(0.49));
}

TEST(FootprintLimits, TablesAnswerEveryRay) {
    for_all_rays([&](const Ray& ray) {
        for (const double d : {-3.2, -1.0, -0.0, 0.0, 0.5, 3.2 - 1e-15, 3.2, 1e9}) {
            for (const double f : {small_table().nearest(ray, d), small_table().lerp(ray, d)}) {
                ASSERT_TRUE(std::isfinite(f));
                ASSERT_GE(f, -2e-3 * kernel_footprint(0)) << "no further below 0 than the correction's own error";
                ASSERT_LE(f, kernel(0) * 2 * (kReach + 1.6));
            }
        }
    });
}

TEST(FootprintLimits, WeightsAtTheirEnds) {
    for (const EdgeBand& band : {EdgeBand{1.6, 16}, EdgeBand{0.05, 64}, EdgeBand{3, 64}, EdgeBand{1.6, 1}}) {
        const EdgeWeights weights = edge_weights(band);
        for (const double d : {-0.5, -1e-300, 0.0, 1e-300, kEdgeWeightReach - 1e-12, kEdgeWeightReach, 1e300}) {
            const double w = edge_weight(d, weights);
            EXPECT_TRUE(std::isfinite(w));
            EXPECT_GE(w, 0);
            EXPECT_LE(w, 2) << band.half_width << " " << band.strength;
        }
        EXPECT_DOUBLE_EQ(edge_weight(kEdgeWeightReach, weights), 1);
        EXPECT_DOUBLE_EQ(edge_weight(1e300, weights), 1);
        const double infinite = std::numeric_limits<double>::infinity();
        EXPECT_DOUBLE_EQ(edge_weight(0.3, infinite, band, weights), edge_weight(0.3, weights));
        EXPECT_DOUBLE_EQ(edge_weight(0.3, 0.3, band, weights), 1) << "a wall this thin is not weighted";
    }
}

TEST(FootprintLimits, TheKernelEndsWhereItsRadiusIs) {
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

TEST(FootprintLimits, SlicesOfNothingAndOfEverything) {
    const Edge edge{.distance = 0.4, .band = {}};
    constexpr double kInfinite = std::numeric_limits<double>::infinity();
    for_all_rays([&](const Ray& ray) {
        const double whole = procedural_footprint(ray, edge, 10);
        ASSERT_NEAR(procedural_footprint(ray, edge, 10, {-kInfinite, kInfinite}), whole, 1e-12);
        ASSERT_NEAR(procedural_footprint(ray, edge, 10, {-1e300, 1e300}), whole, 1e-12);
        ASSERT_NEAR(procedural_footprint(ray, edge, 10, {0.3, 0.3}), 0, 1e-12) << "no thickness";
        ASSERT_NEAR(procedural_footprint(ray, edge, 10, {1e6, 1e7}), 0, 1e-12) << "beyond it";
        // Half-open slices, by the cut's place, add up to the whole up to the rule's own error.
        const double halves = procedural_footprint(ray, edge, 10, {-kInfinite, 0.1}) +
                              procedural_footprint(ray, edge, 10, {0.1, kInfinite});
        ASSERT_NEAR(halves, whole, 5e-3 * kernel_footprint(0));
    });
}

}  // namespace
}  // namespace edgesplat::test
