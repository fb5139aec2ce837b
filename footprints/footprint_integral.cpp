#include "footprints/footprint_integral.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "footprints/gauss_legendre.h"
#include "footprints/kernel.h"

namespace edgesplat {
namespace {

// Squared distance from the voxel to the warped position of the ray's point z (voxels from p): the part along n becomes
// w.
double warped_r2(const Ray& ray, const PaperEdge& edge, double z) {
    const double t = ray.pn + z * ray.un;
    const double w = warped_coordinate(t, edge);
    return ray.rho2 + z * z + (w - t) * (w + t);
}

// Values of t where the displacement is not smooth.
std::vector<double> breaks_of(const PaperEdge& edge) {
    const double start = paper_interval(edge);
    const PaperProfile q = paper_profile_for(edge);
    return {start, start + q.m1, start + q.m2, start + 1};
}

const QuadratureRule& exact_rule() {
    static const QuadratureRule rule = gauss_legendre(20);
    return rule;
}

template <typename Function>
double panel(const Function& f, double low, double high) {
    double sum = 0;
    const QuadratureRule& rule = exact_rule();
    for (std::size_t i = 0; i < rule.size(); ++i)
        sum += rule.weights[i] * f(low + (high - low) * rule.nodes[i]);
    return (high - low) * sum;
}

template <typename Function>
double refine(const Function& f, double low, double high, double whole, int depth) {
    const double middle = (low + high) / 2;
    const double left = panel(f, low, middle), right = panel(f, middle, high);
    if (depth == 0 || std::abs(left + right - whole) < 1e-12) return left + right;
    return refine(f, low, middle, left, depth - 1) + refine(f, middle, high, right, depth - 1);
}

}  // namespace

Ray ray_through(double x, double y, double c) {
    return {x * x + y * y, x * std::sqrt(std::max(0.0, 1 - c * c)), c};
}

double exact_footprint(const Ray& ray, const PaperEdge& edge) {
    // The ray stays at one t: the kernel is shifted, not bent.
    if (std::abs(ray.un) < 1e-9) return kernel_footprint(std::max(0.0, warped_r2(ray, edge, 0)));

    // Beyond this |z| the kernel is out of reach: W moves a point by less than `reach`.
    const double reach = 4 + kKernelRadius;
    std::vector<double> breaks = {-reach, reach};
    for (double t : breaks_of(edge)) {
        const double z = (t - ray.pn) / ray.un;
        if (std::abs(z) < reach) breaks.push_back(z);
    }
    std::sort(breaks.begin(), breaks.end());

    const auto f = [&](double z) { return kernel(warped_r2(ray, edge, z)); };
    const auto outside = [&](double z) { return warped_r2(ray, edge, z) - kKernelRadius * kKernelRadius; };
    double sum = 0;
    for (std::size_t i = 0; i + 1 < breaks.size(); ++i) {
        // Borders of the support within this piece.
        std::vector<double> cuts = {breaks[i]};
        constexpr int kSamples = 24;
        const auto at = [&](int j) { return breaks[i] + (breaks[i + 1] - breaks[i]) * j / kSamples; };
        for (int j = 0; j < kSamples; ++j) {
            double low = at(j), high = at(j + 1);
            const bool low_outside = outside(low) > 0;
            if (low_outside == (outside(high) > 0)) continue;
            for (int step = 0; step < 45; ++step) {
                const double middle = (low + high) / 2;
                ((outside(middle) > 0) == low_outside ? low : high) = middle;
            }
            cuts.push_back(low);
        }
        cuts.push_back(breaks[i + 1]);
        for (std::size_t j = 0; j + 1 < cuts.size(); ++j)
            sum += refine(f, cuts[j], cuts[j + 1], panel(f, cuts[j], cuts[j + 1]), 24);
    }
    return sum;
}

}  // namespace edgesplat
