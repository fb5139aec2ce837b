#include "footprints/face_share.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "footprints/gauss_legendre.h"
#include "footprints/kernel.h"

namespace edgesplat {
namespace {

constexpr double kClosesNowhere = 1e6, kLeastBend = 1e-4;
constexpr double kKernelRadius2 = kKernelRadius * kKernelRadius;

/// Matter that is alike all around the normal, with `across` for its curvature.
double kept(const FaceBody& body, double across, double depth) {
    double sum = 0;
    const QuadratureRule& rule = kept_gauss_legendre(4);
    for (std::size_t i = 0; i < rule.size(); ++i) {
        // Along a line parallel to the normal matter begins `low` under the foot point and ends `high` under it.
        const double rho2 = kKernelRadius2 * rule.nodes[i], rise = across * rho2;
        const double at_face = 1 - body.bend * rise;
        if (!(at_face > 0)) continue;
        const double low = rise / (1 + std::sqrt(at_face));
        double high = body.bend > kLeastBend ? (1 + std::sqrt(at_face)) / body.bend : kClosesNowhere;
        const double at_other = at_face - 2 * body.bend * body.thickness;
        if (std::isfinite(body.thickness) && at_other >= 0)
            high = std::min(high, (rise + 2 * body.thickness) / (1 + std::sqrt(at_other)));
        sum += rule.weights[i] * (kernel_chord(rho2, high - depth) - kernel_chord(rho2, low - depth));
    }
    return std::numbers::pi * kKernelRadius2 * sum;
}

}  // namespace

double face_share(const FaceBody& body, double depth) {
    // Curvature goes as the cosine of twice the angle: two of its values have its mean and its mean square.
    const double apart = body.spread / std::numbers::sqrt2;
    const double share = 0.5 * (kept(body, body.mean + apart, depth) + kept(body, body.mean - apart, depth));
    return std::clamp(share, kernel(0), 1.0);
}

}  // namespace edgesplat
