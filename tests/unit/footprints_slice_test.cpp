// Footprints of curved edges and of slices: against plain sums along the ray, and as parts of a whole.
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
const EdgeBand kBand;
constexpr double kReach = 3.2;  // R + a of that band: no kernel reaches further along a ray

/// Footprints of one edge, whatever its kind.
struct Model {
    const char* name;
    std::function<double(const Ray&, double z)> density;  ///< the kernel at z along the ray
    std::function<double(const Ray&, int nodes, const Slice&)> procedural;
};

Model of(const char* name, const Edge& edge) {
    return {name,
            [edge](const Ray& r, double z) { return kernel(warped_distance2(r.rho2 + z * z, r.pn + z * r.un, edge)); },
            [edge](const Ray& r, int nodes, const Slice& s) { return procedural_footprint(r, edge, nodes, s); }};
}

Model of(const char* name, const PaperEdge& edge) {
    return {name,
            [edge](const Ray& r, double z) {
                const double t = r.pn + z * r.un, w = warped_coordinate(t, edge);
                return kernel(std::max(r.rho2 + z * z - t * t + w * w, 0.0));
            },
            [edge](const Ray& r, int nodes, const Slice& s) { return procedural_footprint(r, edge, nodes, s); }};
}

std::vector<Model> models(double d, double curvature) {
    return {of("plane", Edge{d, kBand}), of("wall", wall_edge(std::abs(d), 1.9 - std::abs(d) / 2, kBand)),
            of("convex", Edge{d, kBand, std::numeric_limits<double>::infinity(), curvature}),
            of("concave", Edge{d, kBand, std::numeric_limits<double>::infinity(), -curvature}),
            of("smooth paper", PaperEdge{d, {0.3, 0.05, PaperCurve::Smooth}})};
}

/// Many short panels, no knowledge of where anything happens.
double brute_force(const Model& model, const Ray& ray, const Slice& slice, int panels = 1500) {
    static const QuadratureRule rule = gauss_legendre(4);
    const double low = std::clamp(slice.low, -5.0, 5.0), high = std::clamp(slice.high, -5.0, 5.0);
    double sum = 0;
    for (int p = 0; p < panels; ++p)
        for (std::size_t i = 0; i < rule.size(); ++i)
            sum += rule.weights[i] * model.density(ray, low + (high - low) * (p + rule.nodes[i]) / panels);
    return sum * (high - low) / panels;
}

/// Every second ray the other way round.
Ray turned(const Ray& ray, std::size_t i) {
    return {ray.rho2, ray.pn, i % 2 == 0 ? ray.un : -ray.un};
}

TEST(SlicedFootprint, AgreesWithPlainSumsOnEveryKindOfEdge) {
    std::mt19937 random(6);
    std::uniform_real_distribution<> place(-3, 3), width(0.05, 0.5), bend(0.02, 0.5);
    std::size_t i = 0;
    for (const auto& [d, plain_ray] : rays(160, -2.9, 2.9, 30)) {
        const Ray ray = turned(plain_ray, i++);
        const double low = place(random);
        const Slice slice = {low, low + width(random)};
        // 16 nodes on half a voxel or less are all but exact; the sums themselves are good to 1e-7. Slopes of the
        // smooth paper's curve jump to 6 at its knots.
        for (const Model& model : models(d, bend(random)))
            ASSERT_NEAR(model.procedural(ray, 16, slice), brute_force(model, ray, slice, 400), 1e-5 * kPeak)
                << model.name << " D " << d << " un " << ray.un << " slice " << slice.low << " " << slice.high;
    }
}

TEST(SlicedFootprint, CosinesOfThePaperTooButForTheirInfiniteSlopes) {
    for (const auto& [d, ray] : rays(100, -0.5, 1.6, 31)) {
        const Model model = of("cosine paper", PaperEdge{d, {}});
        for (const double low : {-0.7, -0.1, 0.2, 0.6})
            EXPECT_NEAR(model.procedural(ray, 16, {low, low + 0.25}), brute_force(model, ray, {low, low + 0.25}),
                        3e-3 * kPeak);
    }
}

TEST(SlicedFootprint, SlicesAddUpToTheWhole) {
    std::mt19937 random(7);
    std::uniform_real_distribution<> bend(0.02, 0.5), start(-0.25, 0);
    Errors plane, curved, warp2d, plain;
    std::size_t i = 0;
    for (const auto& [d, plain_ray] : rays(1000, -2.9, 2.9, 32)) {
        const Ray ray = turned(plain_ray, i++);
        const double c = bend(random), first = start(random) - 3.25;
        const auto total = [&](const auto& footprint) {
            double sum = 0;
            for (int k = 0; k < 28; ++k)
                sum += footprint(Slice{first + 0.25 * k, first + 0.25 * (k + 1)});
            return sum;
        };
        for (const Model& model : models(d, c)) {
            const bool is_curved = model.name[0] == 'c';
            (is_curved ? curved : plane)
                .add(total([&](const Slice& s) { return model.procedural(ray, 4, s); }), model.procedural(ray, 16, {}));
        }
        // The short cut moves the whole line: its slices are those of a plain footprint, in closed form.
        const Edge edge = {d, kBand};
        warp2d.add(total([&](const Slice& s) { return warp2d_footprint(ray, edge, s); }), warp2d_footprint(ray, edge));
        plain.add(total([&](const Slice& s) { return sliced_kernel_footprint(ray.rho2, s); }),
                  kernel_footprint(ray.rho2));
    }
    std::printf("slices with 4 nodes added up, %% of the peak: plane %.5f, curved %.5f\n", 100 * plane.largest(),
                100 * curved.largest());
    // What is left is the whole's own error with 16 nodes.
    EXPECT_LE(plane.largest(), 2e-4);
    EXPECT_LE(curved.largest(), 2e-4);
    EXPECT_LE(warp2d.largest(), 1e-12);
    EXPECT_LE(plain.largest(), 1e-12);
}

TEST(SlicedFootprint, IsNothingOutOfReachAndAllWhereThereIsNoEnd) {
    const double inf = std::numeric_limits<double>::infinity();
    std::size_t i = 0;
    for (const auto& [d, plain_ray] : rays(200, -2.9, 2.9, 33)) {
        const Ray ray = turned(plain_ray, i++);
        for (const Model& model : models(d, 0.3)) {
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
        EXPECT_NEAR(warp2d_footprint(ray, Edge{d, kBand}, {1.6, 5}), 0, 1e-12);
    }
}

TEST(SlicedFootprint, ReversingTheRayReversesTheSlice) {
    for (const auto& [d, ray] : rays(300, -2.9, 2.9, 34))
        for (const Model& model : models(d, 0.4)) {
            // A plane seen edge-on is tilted by 1e-4, so that something is to be divided by; always the same way.
            const bool curved = model.name[0] == 'c';
            EXPECT_NEAR(model.procedural(ray, 4, {-0.3, 0.45}),
                        model.procedural({ray.rho2, ray.pn, -ray.un}, 4, {-0.45, 0.3}), curved ? 1e-9 : 1e-5 * kPeak)
                << model.name << " un " << ray.un;
        }
}

/// Errors of slices of 0.25 voxel all along the rays, with few nodes, against many.
TEST(SlicedFootprint, FourNodesAreEnoughForAQuarterOfAVoxel) {
    std::mt19937 random(8);
    std::uniform_real_distribution<> bend(-0.5, 0.5), start(-0.25, 0);
    Errors plane, wall, curved;
    std::size_t i = 0;
    for (const auto& [d, plain_ray] : rays(3000, -3.2, 3.2, 35)) {
        const Ray ray = turned(plain_ray, i++);
        const Edge flat = {d, kBand}, two = wall_edge(std::abs(d) / 2, 1.9 - std::abs(d) / 4, kBand);
        const Edge bent = {d, kBand, std::numeric_limits<double>::infinity(), bend(random)};
        const double first = start(random);
        for (int k = -11; k < 12; k += 2) {
            const Slice slice = {first + 0.25 * k, first + 0.25 * (k + 1)};
            plane.add(procedural_footprint(ray, flat, 4, slice), procedural_footprint(ray, flat, 16, slice));
            wall.add(procedural_footprint(ray, two, 4, slice), procedural_footprint(ray, two, 16, slice));
            curved.add(procedural_footprint(ray, bent, 4, slice), procedural_footprint(ray, bent, 16, slice));
        }
    }
    std::printf(
        "4 nodes, slices of .25, %% of the peak, largest / p99: plane %.5f / %.5f, wall %.5f, curved %.5f / %.5f\n",
        100 * plane.largest(), 100 * plane.percentile(99), 100 * wall.largest(), 100 * curved.largest(),
        100 * curved.percentile(99));
    // Measured .021 % for slices that end within .25 of a face of slope 16, where the integrand bends most.
    EXPECT_LE(plane.largest(), 3e-4);
    EXPECT_LE(wall.largest(), 3e-4);
    EXPECT_LE(curved.largest(), 3e-4);
    EXPECT_LE(plane.percentile(99), 3e-5);
    EXPECT_LE(curved.percentile(99), 3e-5);
}

TEST(CurvedFootprint, SixteenNodesAreEnoughForTheWhole) {
    std::mt19937 random(9);
    std::uniform_real_distribution<> bend(-0.5, 0.5);
    Errors sixteen, ten;
    std::size_t i = 0;
    for (const auto& [d, plain_ray] : rays(600, -3.2, 3.2, 36)) {
        const Ray ray = turned(plain_ray, i++);
        const Edge edge = {d, kBand, std::numeric_limits<double>::infinity(), bend(random)};
        const double truth = brute_force(of("curved", edge), ray, {}, 2500);
        sixteen.add(procedural_footprint(ray, edge, 16), truth);
        ten.add(procedural_footprint(ray, edge, 10), truth);
    }
    std::printf("whole curved, %% of the peak: 16 nodes %.4f, 10 nodes %.4f\n", 100 * sixteen.largest(),
                100 * ten.largest());
    EXPECT_LE(sixteen.largest(), 2e-4);
    EXPECT_LT(sixteen.largest(), ten.largest());
}

TEST(CurvedFootprint, BecomesThePlanesAsTheCurvatureGoes) {
    Errors errors;
    for (const auto& [d, ray] : rays(2000, -3.2, 3.2, 37))
        for (const double c : {1e-9, -1e-9, 1e-5, -1e-5})
            errors.add(procedural_footprint(ray, {d, kBand, std::numeric_limits<double>::infinity(), c}, 16),
                       procedural_footprint(ray, Edge{d, kBand}, 16));
    std::printf("whole, hardly curved, %% of the peak: %.4f\n", 100 * errors.largest());
    EXPECT_LE(errors.largest(), 3e-4);
}

}  // namespace
}  // namespace edgesplat
