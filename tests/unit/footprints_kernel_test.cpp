#include "footprints/kernel.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "footprints/gauss_legendre.h"
#include "footprints/kernel_fit.h"

namespace edgesplat {
namespace {

template <typename Function>
double integrate(const Function& f, double low, double high) {
    static const QuadratureRule rule = gauss_legendre(40);
    double sum = 0;
    for (std::size_t i = 0; i < rule.size(); ++i)
        sum += rule.weights[i] * f(low + (high - low) * rule.nodes[i]);
    return (high - low) * sum;
}

TEST(Kernel, SumsToOneOverTheLattice) {
    EXPECT_LE(kernel_ripple(48), 1e-4);
    EXPECT_LE(kernel_ripple(48, kNarrowKernel), 0.0125);
}

TEST(Kernel, FootprintsSumToOneInEveryView) {
    for (const Kernel& k : {kKernel, kNarrowKernel}) {
        const double most = k.radius < kKernelRadius ? 0.014 : 5e-5;
        EXPECT_LE(footprint_ripple({0, 0, 1}, 40, k), most);
        EXPECT_LE(footprint_ripple({1, 1, 0}, 24, k), most);
        EXPECT_LE(footprint_ripple({1, 1, 1}, 24, k), most);
        EXPECT_LE(footprint_ripple({0.3, -0.2, 1}, 24, k), most);
        EXPECT_LE(footprint_ripple({0.17, 0.71, -0.6}, 24, k), most);
    }
}

class EachKernel : public testing::TestWithParam<Kernel> {};
INSTANTIATE_TEST_SUITE_P(Kernels, EachKernel, testing::Values(kKernel, kNarrowKernel),
                         [](const auto& test) { return test.param.radius < kKernelRadius ? "narrow" : "wide"; });

TEST_P(EachKernel, FallsSmoothlyToZeroAtItsRadius) {
    const Kernel& k = GetParam();
    for (double r = 0; r < k.radius; r += 0.01)
        EXPECT_GE(kernel(r * r, k), kernel((r + 0.01) * (r + 0.01), k));
    EXPECT_EQ(kernel(k.radius * k.radius, k), 0);
    EXPECT_EQ(kernel(10, k), 0);
    EXPECT_EQ(kernel_footprint(10, k), 0);
    const double r = k.radius - 1e-5;  // C1: K falls like the square of the distance to the border
    EXPECT_LT(kernel(r * r, k), 1e-9);
}

TEST_P(EachKernel, ClosedFormsEqualIntegrals) {
    const Kernel& k = GetParam();
    for (double share : {0.0, 0.25, 0.56, 0.94}) {
        const double rho = share * k.radius, half = std::sqrt(k.radius * k.radius - rho * rho);
        const auto along = [&](double z) { return kernel(rho * rho + z * z, k); };
        EXPECT_NEAR(kernel_footprint(rho * rho, k), integrate(along, -half, half), 1e-13);
        for (double z : {-2.0, -0.3, 0.0, 0.5, 1.0}) {
            const double end = std::clamp(z, -half, half);
            EXPECT_NEAR(kernel_chord(rho * rho, z, k), integrate(along, 0, end), 1e-13);
        }
        const auto ring = [&](double e) { return 2 * 3.14159265358979324 * e * kernel(rho * rho + e * e, k); };
        EXPECT_NEAR(kernel_plane_integral(rho * rho, k), integrate(ring, 0, half), 1e-13);
    }
    const auto shell = [&](double r) { return 4 * 3.14159265358979324 * r * r * kernel(r * r, k); };
    EXPECT_NEAR(integrate(shell, 0, k.radius), 1, 1e-7);
}

TEST_P(EachKernel, FitReproducesKernel) {
    const Kernel& k = GetParam();
    const Kernel fitted = fit_kernel(24, k.radius);
    EXPECT_LE(kernel_ripple(48, fitted), kernel_ripple(48, k) * 1.03);
    EXPECT_GE(kernel_ripple(48, fitted), kernel_ripple(48, k) * 0.9);
    for (double w = 0.02; w <= 1; w += 0.02) {
        const auto at = [&](double v) { return kernel((1 - v) * k.radius * k.radius, fitted); };
        EXPECT_GE(at(w), at(w - 0.02) - 1e-12) << "not monotone at w = " << w;
    }
    EXPECT_THROW(fit_kernel(1), std::invalid_argument);
    EXPECT_THROW(fit_kernel(24, 0.5), std::invalid_argument);
}

}  // namespace
}  // namespace edgesplat
