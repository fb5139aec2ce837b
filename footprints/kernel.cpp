#include "footprints/kernel.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace edgesplat {
namespace {

double remaining(double r2, const Kernel& k) {
    return std::max(0.0, 1 - r2 / (k.radius * k.radius));
}

}  // namespace

const KernelCoefficients& kept_footprint_coefficients(const Kernel& k) {
    static constexpr KernelCoefficients kWide = footprint_coefficients(kKernel);
    static constexpr KernelCoefficients kNarrow = footprint_coefficients(kNarrowKernel);
    return k.radius < kKernelRadius ? kNarrow : kWide;
}

double kernel_footprint(double rho2, const Kernel& k) {
    return in_double::KernelSource(k, &kept_footprint_coefficients(k)).kernel_footprint(rho2);
}

double kernel_chord(double rho2, double z, const Kernel& k) {
    return in_double::KernelSource(k).kernel_chord(rho2, z);
}

double kernel_plane_integral(double r2, const Kernel& k) {
    const double w = remaining(r2, k);
    double sum = 0;
    double power = w * w * w;
    for (std::size_t i = 0; i < k.coefficients.size(); ++i, power *= w)
        sum += k.coefficients[i] / (static_cast<double>(i) + 3) * power;
    return std::numbers::pi * k.radius * k.radius * sum;
}

double kernel_ripple(int steps, const Kernel& k) {
    double worst = 0;
    // The lattice sum has the cube's symmetry: 0 <= z <= y <= x <= 1/2 is enough.
    for (int ix = 0; ix <= steps; ++ix)
        for (int iy = 0; iy <= ix; ++iy)
            for (int iz = 0; iz <= iy; ++iz) {
                const double x = 0.5 * ix / steps, y = 0.5 * iy / steps, z = 0.5 * iz / steps;
                double sum = 0;
                for (int i = -2; i <= 2; ++i)
                    for (int j = -2; j <= 2; ++j)
                        for (int l = -2; l <= 2; ++l)
                            sum += kernel((x - i) * (x - i) + (y - j) * (y - j) + (z - l) * (z - l), k);
                worst = std::max(worst, std::abs(sum - 1));
            }
    return worst;
}

double footprint_ripple(const std::array<double, 3>& direction, int steps, const Kernel& kernel) {
    const double length = std::hypot(direction[0], direction[1], direction[2]);
    const std::array<double, 3> u = {direction[0] / length, direction[1] / length, direction[2] / length};
    // The sum along the ray, lattice plane by lattice plane across the dominant axis. A smooth window over the planes
    // gives the mean deviation per unit length whatever the period of the direction.
    int axis = 0;
    for (int i = 1; i < 3; ++i)
        if (std::abs(u[static_cast<std::size_t>(i)]) > std::abs(u[static_cast<std::size_t>(axis)])) axis = i;
    const auto a = static_cast<std::size_t>(axis), b = (a + 1) % 3, c = (a + 2) % 3;
    constexpr int kPlanes = 240;
    double worst = 0;
    for (int ib = 0; ib < steps; ++ib)
        for (int ic = 0; ic < steps; ++ic) {
            double total = 0;
            for (int p = 0; p < kPlanes; ++p) {
                // Where the ray meets lattice plane p, and the voxels of that plane near it.
                const double hit_b = (ib + 0.5) / steps + p * u[b] / u[a];
                const double hit_c = (ic + 0.5) / steps + p * u[c] / u[a];
                double sum = 0;
                for (int j = -4; j <= 4; ++j)
                    for (int k = -4; k <= 4; ++k) {
                        const double db = std::floor(hit_b) + j - hit_b, dc = std::floor(hit_c) + k - hit_c;
                        const double along = db * u[b] + dc * u[c];
                        sum += kernel_footprint(std::max(0.0, db * db + dc * dc - along * along), kernel);
                    }
                total += sum * (1 - std::cos(2 * std::numbers::pi * (p + 0.5) / kPlanes)) / kPlanes;
            }
            worst = std::max(worst, std::abs(total * std::abs(u[a]) - 1));
        }
    return worst;
}

}  // namespace edgesplat
