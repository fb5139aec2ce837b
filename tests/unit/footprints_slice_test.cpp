// Footprints of slices: compared with plain sums along the ray, and their sum with the whole footprint.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <functional>
#include <limits>
#include <random>
#include <vector>

#include "footprints/gauss_legendre.h"
#include "tests/unit/footprints_samples.h"

namespace edgesplat {
namespace {

using samples::Errors;
using samples::kPeak;
using samples::rays;
constexpr double kReach = kPaperReach;  // no kernel reaches further along a ray

/// The kernel and the footprint of one edge.
struct Model {
    const char* name;
    std::function<double(const Ray&, double z)> density;  ///< the kernel at z along the ray
    std::function<double(const Ray&, int nodes, const Slice&)> procedural;
};

Model of(const char* name, const PaperEdge& edge) {
    return {name,
            [edge](const Ray& r, double z) {
                const double t = r.pn + z * r.un, w = warped_coordinate(t, edge);
                return kernel(std::max(r.rho2 + z * z - t * t + w * w, 0.0));
            },
            [edge](const Ray& r, int nodes, const Slice& s) { return procedural_footprint(r, edge, nodes, s); }};
}

std::vector<Model> models(double d) {
    return {of("cosine paper", PaperEdge{d, {}}), of("smooth paper", PaperEdge{d, {0.3, 0.05, PaperCurve::Smooth}})};
}

/// Many short panels, without knowledge of the integrand's kinks.
double brute_force(const Model& model, const Ray& ray, const Slice& slice, int panels = 1500) {
    static const QuadratureRule rule = gauss_legendre(4);
    const double low = std::clamp(slice.low, -5.0, 5.0), high = std::clamp(slice.high, -5.0, 5.0);
    double sum = 0;
    for (int p = 0; p < panels; ++p)
        for (std::size_t i = 0; i < rule.size(); ++i)
            sum += rule.weights[i] * model.density(ray, low + (high - low) * (p + rule.nodes[i]) / panels);
    return sum * (high - low) / panels;
}

/// Reverses every second ray.
Ray turned_ray(const Ray& ray, std::size_t i) {
    return {ray.rho2, ray.pn, i % 2 == 0 ? ray.un : -ray.un};
}

TEST(SlicedFootprint, AgreesWithPlainSums) {
    std::mt19937 random(6);
    std::uniform_real_distribution<> place(-3, 3), width(0.05, 0.5);
    std::size_t i = 0;
    for (const auto& [d, plain_ray] : rays(160, -2.9, 2.9, 30)) {
        const Ray ray = turned_ray(plain_ray, i++);
        const double low = place(random);
        const Slice slice = {low, low + width(random)};
        // The slope of the smooth curve jumps to 6 at its knots; there the sums are accurate to 1e-5.
        const Model model = of("smooth paper", PaperEdge{d, {0.3, 0.05, PaperCurve::Smooth}});
        ASSERT_NEAR(model.procedural(ray, 10, slice), brute_force(model, ray, slice, 400), 1e-4 * kPeak)
            << "D " << d << " un " << ray.un << " slice " << slice.low << " " << slice.high;
    }
}

TEST(SlicedFootprint, PaperCosinesAgreeWithPlainSums) {
    for (const auto& [d, ray] : rays(100, -0.5, 1.6, 31)) {
        const Model model = of("cosine paper", PaperEdge{d, {}});
        for (const double low : {-0.7, -0.1, 0.2, 0.6})
            EXPECT_NEAR(model.procedural(ray, 10, {low, low + 0.25}), brute_force(model, ray, {low, low + 0.25}),
                        3e-3 * kPeak);
    }
}

TEST(SlicedFootprint, SlicesAddUpToTheWhole) {
    std::mt19937 random(7);
    std::uniform_real_distribution<> start(-0.25, 0);
    Errors smooth, warp2d, plain;
    std::size_t i = 0;
    for (const auto& [d, plain_ray] : rays(1000, -2.9, 2.9, 32)) {
        const Ray ray = turned_ray(plain_ray, i++);
        const double first = start(random) - 3.25;
        const auto total = [&](const auto& footprint) {
            double sum = 0;
            for (int k = 0; k < 28; ++k)
                sum += footprint(Slice{first + 0.25 * k, first + 0.25 * (k + 1)});
            return sum;
        };
        const PaperEdge edge = {d, {0.3, 0.05, PaperCurve::Smooth}};
        smooth.add(total([&](const Slice& s) { return procedural_footprint(ray, edge, 4, s); }),
                   exact_footprint(ray, edge));
        // warp2d shifts the whole ray: its slices are slices of a plain footprint, in closed form.
        warp2d.add(total([&](const Slice& s) { return warp2d_footprint(ray, edge, s); }), warp2d_footprint(ray, edge));
        plain.add(total([&](const Slice& s) { return sliced_kernel_footprint(ray.rho2, s); }),
                  kernel_footprint(ray.rho2));
    }
    std::printf("slices with 4 nodes added up, %% of the peak: %.5f\n", 100 * smooth.largest());
    EXPECT_LE(smooth.largest(), 1e-3);
    EXPECT_LE(warp2d.largest(), 1e-12);
    EXPECT_LE(plain.largest(), 1e-12);
}

TEST(SlicedFootprint, IsZeroOutOfReachAndWholeWithoutLimits) {
    const double inf = std::numeric_limits<double>::infinity();
    std::size_t i = 0;
    for (const auto& [d, plain_ray] : rays(200, -2.9, 2.9, 33)) {
        const Ray ray = turned_ray(plain_ray, i++);
        for (const Model& model : models(d)) {
            for (const Slice& beyond : {Slice{kReach, kReach + 0.25}, Slice{-50, -kReach}, Slice{kReach, inf}})
                EXPECT_NEAR(model.procedural(ray, 4, beyond), 0, 1e-12) << model.name;
            EXPECT_NEAR(model.procedural(ray, 10, {0.3, 0.3}), 0, 1e-12) << model.name << ": an empty slice";
            const double whole = model.procedural(ray, 10, {});
            EXPECT_EQ(model.procedural(ray, 10, {-inf, inf}), whole) << model.name;
            EXPECT_NEAR(model.procedural(ray, 10, {-1e9, 1e9}), whole, 1e-12) << model.name;
            EXPECT_NEAR(model.procedural(ray, 10, {-kReach, kReach}), whole, 1e-12) << model.name;
        }
        EXPECT_EQ(sliced_kernel_footprint(ray.rho2, {1.6, 5}), 0);
        EXPECT_NEAR(sliced_kernel_footprint(ray.rho2, {}), kernel_footprint(ray.rho2), 1e-12);
        EXPECT_NEAR(warp2d_footprint(ray, PaperEdge{d, {}}, {1.6, 5}), 0, 1e-12);
    }
}

TEST(SlicedFootprint, ReversingTheRayReversesTheSlice) {
    for (const auto& [d, ray] : rays(300, -2.9, 2.9, 34))
        for (const Model& model : models(d)) {
            // procedural_footprint tilts an edge-on plane by 1e-4 to avoid a division by 0, always in the same
            // direction.
            EXPECT_NEAR(model.procedural(ray, 4, {-0.3, 0.45}),
                        model.procedural({ray.rho2, ray.pn, -ray.un}, 4, {-0.45, 0.3}), 1e-5 * kPeak)
                << model.name << " un " << ray.un;
        }
}

}  // namespace
}  // namespace edgesplat
