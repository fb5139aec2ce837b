// The reconstruction kernels K7 and their integrals over a line, part of a line, and a plane, all in closed form.
//
// K is a polynomial in w = max(0, 1 - r^2/R^2), so its integral along any straight line has a closed form, too.
// The coefficients come from fit_kernel.cpp. Lengths are voxels; the integral of K over space is 1.
#pragma once

#include <array>
#include <cstddef>

#include "footprints/in_double.h"

namespace edgesplat {

using KernelCoefficients = std::array<double, 6>;

/// A kernel K(r).
struct Kernel {
    double radius;                    ///< R, voxels
    KernelCoefficients coefficients;  ///< of w^2 ... w^7
};

/// The kernel of plain splats, of the paper's method and of translucent matter. Its sum over the lattice is 1 to within
/// 7e-5.
inline constexpr Kernel kKernel = {1.6,
                                   {0.0173624837, -0.0404017909, 0.531403221, -0.680940898, 1.37803587, -0.611612954}};
/// The narrow kernel of scenes where faces cut kernels and all matter is opaque. Its sum is 1 to within 1.2 %, which
/// does not show; a ray passes .6 as many of these kernels.
inline constexpr Kernel kNarrowKernel = {1.21,
                                         {1.3647426, -7.69352155, 25.8377679, -41.6868634, 33.3112006, -10.4390086}};
inline constexpr double kKernelRadius = kKernel.radius;

/// Weight of w^n in the line integral, relative to its weight in K: R * integral of (1-s^2)^n over [-1, 1].
constexpr double kernel_line_factor(double radius, int n) {
    double factor = 2 * radius;
    for (int i = 1; i <= n; ++i)
        factor *= 2.0 * i / (2.0 * i + 1.0);
    return factor;
}

/// Coefficients of w^2.5 ... w^7.5 in the footprint g.
constexpr KernelCoefficients footprint_coefficients(const Kernel& k) {
    KernelCoefficients c{};
    for (std::size_t i = 0; i < c.size(); ++i)
        c[i] = k.coefficients[i] * kernel_line_factor(k.radius, static_cast<int>(i) + 2);
    return c;
}

/// The same of a scene's kernel, kept.
const KernelCoefficients& kept_footprint_coefficients(const Kernel& k);

namespace in_double {
/// kernel.glsl, with the kernel that it asks for.
struct KernelSource {
    explicit KernelSource(const Kernel& k, const KernelCoefficients* footprint = nullptr)
        : KERNEL_R(k.radius),
          KERNEL_R2(k.radius * k.radius),
          KERNEL_INVERSE_R2(1 / KERNEL_R2),
          KERNEL_K(k.coefficients.data()),
          KERNEL_G(footprint ? footprint->data() : nullptr) {}

    double KERNEL_R, KERNEL_R2, KERNEL_INVERSE_R2;
    const double *KERNEL_K, *KERNEL_G;
    static constexpr int KERNEL_SET = 0;

#define Real double
#include "footprints/kernel.glsl"
#undef Real
};
}  // namespace in_double

/// K at a squared distance r2 >= 0 from its centre; 0 from R on.
inline double kernel(double r2, const Kernel& k = kKernel) {
    return in_double::KernelSource(k).kernel(r2);
}

/// g: integral of K along a line that passes its centre at squared distance rho2 >= 0.
double kernel_footprint(double rho2, const Kernel& k = kKernel);

/// Integral of K along that line, from its point nearest to the centre to the point z voxels further; odd in z.
double kernel_chord(double rho2, double z, const Kernel& k = kKernel);

/// Integral of K over a plane at squared distance r2 >= 0: the kernel of one-dimensional reconstruction.
double kernel_plane_integral(double r2, const Kernel& k = kKernel);

/// Largest |sum over the lattice of K - 1|, at steps^3 points of one octant of the unit cell.
double kernel_ripple(int steps, const Kernel& k = kKernel);

/// Largest |lattice sum of g * area per sample - 1| over a view along `direction` (any non-zero vector), at `steps`^2
/// points: how even a uniform volume looks when its footprints are added up.
double footprint_ripple(const std::array<double, 3>& direction, int steps, const Kernel& k = kKernel);

}  // namespace edgesplat
