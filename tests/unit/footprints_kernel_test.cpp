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
}

TEST(Kernel, FootprintsSumToOneInEveryView) {
    EXPECT_LE(footprint_ripple({0, 0, 1}, 40), 5e-5);
    EXPECT_LE(footprint_ripple({1, 1, 0}, 24), 5e-5);
    EXPECT_LE(footprint_ripple({1, 1, 1}, 24), 5e-5);
    EXPECT_LE(footprint_ripple({0.3, -0.2, 1}, 24), 5e-5);
    EXPECT_LE(footprint_ripple({0.17, 0.71, -0.6}, 24), 5e-5);
}

TEST(Kernel, FallsSmoothlyToZeroAtItsRadius) {
    for (double r = 0; r < kKernelRadius; r += 0.01)
        EXPECT_GE(kernel(r * r), kernel((r + 0.01) * (r + 0.01)));
    EXPECT_EQ(kernel(kKernelRadius * kKernelRadius), 0);
    EXPECT_EQ(kernel(10), 0);
    EXPECT_EQ(kernel_footprint(10), 0);
    const double r = kKernelRadius - 1e-5;  // C1: K falls like the square of the distance to the border
    EXPECT_LT(kernel(r * r), 1e-11);
}

TEST(Kernel, ClosedFormsAreTheIntegralsTheyClaimToBe) {
    for (double rho : {0.0, 0.4, 0.9, 1.5}) {
        const double half = std::sqrt(kKernelRadius * kKernelRadius - rho * rho);
        const auto along = [&](double z) { return kernel(rho * rho + z * z); };
        EXPECT_NEAR(kernel_footprint(rho * rho), integrate(along, -half, half), 1e-13);
        for (double z : {-2.0, -0.3, 0.0, 0.5, 1.0}) {
            const double end = std::clamp(z, -half, half);
            EXPECT_NEAR(kernel_chord(rho * rho, z), integrate(along, 0, end), 1e-13);
        }
        const auto ring = [&](double e) { return 2 * 3.14159265358979324 * e * kernel(rho * rho + e * e); };
        EXPECT_NEAR(kernel_plane_integral(rho * rho), integrate(ring, 0, half), 1e-13);
    }
    const auto shell = [](double r) { return 4 * 3.14159265358979324 * r * r * kernel(r * r); };
    EXPECT_NEAR(integrate(shell, 0, kKernelRadius), 1, 1e-8);
}

TEST(Kernel, FittingItAgainFindsNothingMuchBetterOrWorse) {
    const KernelCoefficients fitted = fit_kernel(24);
    EXPECT_LE(kernel_ripple(48, fitted), kernel_ripple(48) * 1.01);
    EXPECT_GE(kernel_ripple(48, fitted), kernel_ripple(48) * 0.9);
    for (double w = 0.02; w <= 1; w += 0.02) {
        const auto at = [&](double v) { return kernel((1 - v) * kKernelRadius * kKernelRadius, fitted); };
        EXPECT_GE(at(w), at(w - 0.02) - 1e-12) << "not monotone at w = " << w;
    }
    EXPECT_THROW(fit_kernel(1), std::invalid_argument);
}

}  // namespace
}  // namespace edgesplat
