#include "footprints/footprint_integral.h"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

#include "footprints/gauss_legendre.h"
#include "tests/unit/footprints_samples.h"

namespace edgesplat {
namespace {

using samples::Errors;
using samples::rays;
constexpr double kR = kKernelRadius;
const EdgeBand kBand = {1.3, 12};

// An independent way to the same number: many short panels, no knowledge of where anything happens.
template <typename AnyEdge>
double brute_force(const Ray& ray, const AnyEdge& edge) {
    static const QuadratureRule rule = gauss_legendre(4);
    constexpr int kPanels = 4000;
    double sum = 0;
    for (int p = 0; p < kPanels; ++p)
        for (std::size_t i = 0; i < rule.size(); ++i) {
            const double z = 8 * ((p + rule.nodes[i]) / kPanels - 0.5);
            const double t = ray.pn + z * ray.un, w = warped_coordinate(t, edge);
            sum += rule.weights[i] * kernel(ray.rho2 + z * z - t * t + w * w);
        }
    return sum * 8 / kPanels;
}

TEST(ExactFootprint, AgreesWithBruteForce) {
    for (const auto& [d, ray] : rays(300, -2.9, 2.9))
        EXPECT_NEAR(exact_footprint(ray, Edge{d, kBand}), brute_force(ray, Edge{d, kBand}), 1e-7);
    for (const auto& [d, ray] : rays(100, -0.5, 1.6))  // infinite slopes: brute force itself is good to about 1e-5
        EXPECT_NEAR(exact_footprint(ray, PaperEdge{d, {}}), brute_force(ray, PaperEdge{d, {}}), 1e-4);
    for (const auto& [d, ray] : rays(100, -0.5, 1.6)) {
        const PaperEdge smooth = {d, {0.3, 0.05, PaperCurve::Smooth}};
        EXPECT_NEAR(exact_footprint(ray, smooth), brute_force(ray, smooth), 1e-6);
        const Edge wall = wall_edge(d, 1.8 - d, kBand);
        EXPECT_NEAR(exact_footprint(ray, wall), brute_force(ray, wall), 1e-7);
    }
}

TEST(ExactFootprint, HasTheSymmetriesOfTheWarp) {
    for (const auto& [d, ray] : rays(300, -2.9, 2.9, 2)) {
        const double f = exact_footprint(ray, Edge{d, kBand});
        EXPECT_NEAR(exact_footprint({ray.rho2, ray.pn, -ray.un}, Edge{d, kBand}), f, 1e-10);
        EXPECT_NEAR(exact_footprint({ray.rho2, -ray.pn, ray.un}, Edge{-d, kBand}), f, 1e-10);
    }
}

TEST(ExactFootprint, IsPlainWithoutAWarp) {
    for (const auto& [d, ray] : rays(300, -2.9, 2.9, 3)) {
        const double g = kernel_footprint(ray.rho2);
        EXPECT_NEAR(exact_footprint(ray, Edge{d, {1.3, 1}}), g, 1e-10);
        EXPECT_NEAR(exact_footprint(ray, Edge{kR + 1.3, kBand}), g, 1e-10);
        EXPECT_NEAR(exact_footprint(ray, Edge{-kR - 1.3 + 1e-6, kBand}), g, 1e-8);  // and fades out without a step
        EXPECT_NEAR(exact_footprint(ray, PaperEdge{1.7, {}}), g, 1e-10);
    }
}

TEST(ExactFootprint, EdgeOnIsTheShiftedFootprint) {
    for (double x = -1.5; x <= 1.5; x += 0.05) {
        const double w = 0.4 + edge_warp(x - 0.4, kBand);
        EXPECT_NEAR(exact_footprint(ray_through(x, 0.3, 0), Edge{0.4, kBand}), kernel_footprint(w * w + 0.09), 1e-12);
        EXPECT_NEAR(exact_footprint(ray_through(x, 0.3, 1e-7), Edge{0.4, kBand}), kernel_footprint(w * w + 0.09), 1e-8);
    }
}

TEST(ExactFootprint, CarriesTheSameMassInEveryView) {
    // The integral over the picture is the warped kernel's volume, whatever the direction.
    const Edge edge = {0.6, {1.3, 8}};
    double volume = 0;
    for (int i = 0; i < 4000; ++i) {
        const double t = -4 + 8 * (i + 0.5) / 4000, w = warped_coordinate(t, edge);
        volume += kernel_plane_integral(w * w) * 8 / 4000;
    }
    for (double c : {0.0, 0.4, 0.8, 1.0}) {
        double mass = 0;
        constexpr double kStep = 0.025;
        for (double x = -2.5 + kStep / 2; x < 2.5; x += kStep)
            for (double y = kStep / 2; y < kR; y += kStep)
                mass += 2 * kStep * kStep * exact_footprint(ray_through(x, y, c), edge);
        EXPECT_NEAR(mass, volume, 3e-4) << c;
    }
}

TEST(ExactFootprint, AWallIsTheSumOfItsFaces) {
    for (const auto& [d, ray] : rays(300, 0, 1, 4))
        for (double thickness : {1.3, 2.2}) {
            const Edge wall = wall_edge(d, thickness - d, kBand);
            ASSERT_TRUE(std::isfinite(wall.second_distance));
            const double near_face = exact_footprint(ray, Edge{d, wall.band});
            const double far_face = exact_footprint(ray, Edge{d - thickness, wall.band});
            EXPECT_NEAR(exact_footprint(ray, wall), near_face + far_face - kernel_footprint(ray.rho2), 1e-10);
        }
}

TEST(ProceduralFootprint, IsWithinATenthOfAPercent) {
    for (const EdgeBand& band : {EdgeBand{1.3, 8}, EdgeBand{1.3, 16}, EdgeBand{}}) {
        Errors errors;
        const double reach = kKernelRadius + band.half_width;
        for (const auto& [d, ray] : rays(6000, -reach, reach, 5)) {
            const Edge edge = {d, band};
            errors.add(procedural_footprint(ray, edge), exact_footprint(ray, edge));
        }
        RecordProperty("max_error_percent_k" + std::to_string(static_cast<int>(band.strength)),
                       std::to_string(100 * errors.largest()));
        EXPECT_LE(errors.largest(), 0.001) << band.half_width << " " << band.strength;
    }
}

TEST(ProceduralFootprint, ConvergesWithItsNodes) {
    Errors coarse, fine;
    for (const auto& [d, ray] : rays(2000, -2.9, 2.9, 6)) {
        const double truth = exact_footprint(ray, Edge{d, kBand});
        coarse.add(procedural_footprint(ray, Edge{d, kBand}, 6), truth);
        fine.add(procedural_footprint(ray, Edge{d, kBand}, 16), truth);
    }
    EXPECT_LE(fine.largest(), 1e-4);
    EXPECT_LT(fine.largest(), coarse.largest() / 10);
    EXPECT_THROW(procedural_footprint({}, Edge{}, 7), std::invalid_argument);
}

TEST(ProceduralFootprint, TreatsWallsAlike) {
    Errors errors;
    for (const auto& [d, ray] : rays(4000, 0, 2, 7)) {
        const Edge wall = wall_edge(d, std::abs(ray.pn) + 0.5, kBand);
        errors.add(procedural_footprint(ray, wall), exact_footprint(ray, wall));
    }
    EXPECT_LE(errors.largest(), 0.003);
}

TEST(ProceduralFootprint, PaperCurvesCostMoreNodesForTheirInfiniteSlopes) {
    Errors cosine, smooth;
    for (const auto& [d, ray] : rays(4000, -0.5, 1.6, 8)) {
        const PaperEdge edge = {d, {}}, smooth_edge = {d, {0.3, 0.05, PaperCurve::Smooth}};
        cosine.add(procedural_footprint(ray, edge), exact_footprint(ray, edge));
        smooth.add(procedural_footprint(ray, smooth_edge), exact_footprint(ray, smooth_edge));
    }
    RecordProperty("cosine_max_percent", std::to_string(100 * cosine.largest()));
    RecordProperty("smooth_max_percent", std::to_string(100 * smooth.largest()));
    EXPECT_LE(cosine.largest(), 0.003);
    EXPECT_LE(smooth.largest(), 0.003);
}

TEST(Warp2d, IsExactEdgeOnAndPlainAlongTheNormal) {
    for (double x = -2; x <= 2; x += 0.1) {
        const Ray edge_on = ray_through(x, 0.4, 0), along = ray_through(x, 0.4, 1);
        EXPECT_NEAR(warp2d_footprint(edge_on, Edge{0.7, kBand}), exact_footprint(edge_on, Edge{0.7, kBand}), 1e-12);
        EXPECT_NEAR(warp2d_footprint(edge_on, PaperEdge{0.7, {}}), exact_footprint(edge_on, PaperEdge{0.7, {}}), 1e-12);
        EXPECT_NEAR(warp2d_footprint(along, Edge{0.7, kBand}), kernel_footprint(along.rho2), 1e-12);
    }
}

TEST(Warp2d, IsAShortCutInBetween) {
    Errors errors;
    for (const auto& [d, ray] : rays(4000, 0, 2.9, 9))
        errors.add(warp2d_footprint(ray, Edge{d, kBand}), exact_footprint(ray, Edge{d, kBand}));
    RecordProperty("max_error_percent", std::to_string(100 * errors.largest()));
    EXPECT_GT(errors.largest(), 0.05);  // why the table exists
}

}  // namespace
}  // namespace edgesplat
