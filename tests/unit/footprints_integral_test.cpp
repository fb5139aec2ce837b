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

// Independent integral: many short panels, without knowledge of the integrand's kinks.
double brute_force(const Ray& ray, const PaperEdge& edge) {
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
    for (const auto& [d, ray] : rays(100, -0.5, 1.6))  // infinite slopes: brute force is accurate to about 1e-5
        EXPECT_NEAR(exact_footprint(ray, PaperEdge{d, {}}), brute_force(ray, PaperEdge{d, {}}), 1e-4);
    for (const auto& [d, ray] : rays(100, -0.5, 1.6)) {
        const PaperEdge smooth = {d, {0.3, 0.05, PaperCurve::Smooth}};
        EXPECT_NEAR(exact_footprint(ray, smooth), brute_force(ray, smooth), 1e-6);
    }
}

TEST(ExactFootprint, StaysWithinDocumentedReach) {
    double farthest = 0;
    for (const auto& [d, ray] : rays(20000, -0.5, 1.6, 4)) {
        const double z = std::sqrt(std::max(kPaperReach * kPaperReach - ray.rho2, 0.0)) + 1e-9;
        for (const double end : {z, -z}) {
            const double t = ray.pn + end * ray.un, w = warped_coordinate(t, PaperEdge{d, {}});
            EXPECT_EQ(kernel(std::max(ray.rho2 + end * end - t * t + w * w, 0.0)), 0) << d;
        }
        for (int i = 0; i <= 40; ++i) {
            const double at = (i / 20.0 - 1) * 2.5, t = ray.pn + at * ray.un, r2 = ray.rho2 + at * at;
            const double w = warped_coordinate(t, PaperEdge{d, {}});
            if (kernel(std::max(r2 - t * t + w * w, 0.0)) > 0) farthest = std::max(farthest, std::sqrt(r2));
        }
    }
    EXPECT_GT(farthest, 1.83) << "the bound is tight";
}

TEST(ExactFootprint, IsPlainWithoutAWarp) {
    for (const auto& [d, ray] : rays(300, -2.9, 2.9, 3)) {
        const double g = kernel_footprint(ray.rho2);
        EXPECT_NEAR(exact_footprint(ray, PaperEdge{1.7, {}}), g, 1e-10);
    }
}

TEST(ExactFootprint, IsShiftedFootprintEdgeOn) {
    for (double x = -1.5; x <= 1.5; x += 0.05) {
        const PaperEdge edge = {0.4, {0.3, 0.05, PaperCurve::Smooth}};
        const double w = warped_coordinate(x, edge);
        EXPECT_NEAR(exact_footprint(ray_through(x, 0.3, 0), edge), kernel_footprint(w * w + 0.09), 1e-12);
        EXPECT_NEAR(exact_footprint(ray_through(x, 0.3, 1e-7), edge), kernel_footprint(w * w + 0.09), 1e-6);
    }
}

TEST(ExactFootprint, HasSameMassInEveryView) {
    // The integral over the picture is the warped kernel's volume in every direction.
    const PaperEdge edge = {0.6, {0.3, 0.05, PaperCurve::Smooth}};
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

TEST(ProceduralFootprint, IsAccurateForPaperCurves) {
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
    EXPECT_THROW(procedural_footprint({}, PaperEdge{}, 7), std::invalid_argument);
}

TEST(Warp2d, IsExactEdgeOnAndPlainAlongTheNormal) {
    for (double x = -2; x <= 2; x += 0.1) {
        const Ray edge_on = ray_through(x, 0.4, 0), along = ray_through(x, 0.4, 1);
        EXPECT_NEAR(warp2d_footprint(edge_on, PaperEdge{0.7, {}}), exact_footprint(edge_on, PaperEdge{0.7, {}}), 1e-12);
        EXPECT_NEAR(warp2d_footprint(along, PaperEdge{0.7, {}}), kernel_footprint(along.rho2), 1e-12);
    }
}

TEST(Warp2d, IsInexactAtObliqueAngles) {
    Errors errors;
    for (const auto& [d, ray] : rays(4000, 0, 1.6, 9))
        errors.add(warp2d_footprint(ray, PaperEdge{d, {}}), exact_footprint(ray, PaperEdge{d, {}}));
    RecordProperty("max_error_percent", std::to_string(100 * errors.largest()));
    EXPECT_GT(errors.largest(), 0.05);  // a tilted edge blurs in projection
}

}  // namespace
}  // namespace edgesplat
