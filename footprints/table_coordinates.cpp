#include "footprints/table_coordinates.h"

#include <algorithm>
#include <cmath>

#include "footprints/kernel.h"

namespace edgesplat {
namespace {

// Measured: 0.3 ... 0.6 differ little. About the distance from its middle at which half of a kernel's chord lies.
constexpr double kMeanReach = 0.4;  // voxels
// Layers are 1 + 1/kSpread times as dense edge-on as evenly spaced ones; measured at k = 8, 12, 16.
constexpr double kSpread = 0.4;

EdgeBand base_band(double c, const EdgeBand& band) {
    return {band.half_width, table_base_strength(c, band)};
}

// X of a point x on the projected normal's axis.
double base_coordinate(double x, double s, double d, const EdgeBand& base) {
    const double t = x * s - d;
    return x + s * (edge_warp(t, base) - t);
}

}  // namespace

// c / (1 + s) is the tangent of half the angle between ray and plane: linear in the angle at both ends, where F is too.
double table_direction_coordinate(double c) {
    const double s = std::sqrt(std::max(0.0, 1 - c * c));
    return (1 + kSpread) * c / (c + kSpread * (1 + s));
}

double table_direction(double coordinate) {
    const double f = kSpread * coordinate / (1 + kSpread - coordinate);
    return 2 * f / (1 + f * f);
}

double table_base_strength(double c, const EdgeBand& band) {
    // M(s)/s at the mean distance from the edge, s = c kMeanReach.
    const double v = std::min(1.0, c * kMeanReach / band.half_width), k = band.strength;
    return (v + k * (1 - v)) / (1 + (k - 1) * v * (1 - v));
}

TablePoint table_point(const Ray& ray, double distance, const EdgeBand& band) {
    const double d = std::abs(distance), pn = distance < 0 ? -ray.pn : ray.pn;
    const double c = std::min(std::abs(ray.un), 1.0), s2 = 1 - c * c, s = std::sqrt(s2);
    const double delta = edge_warp(pn - d, base_band(c, band)) - (pn - d);
    // Along the normal x is any direction: the clamps keep the quotient harmless there.
    const double rho = std::sqrt(ray.rho2);
    const double x = std::clamp(pn / std::max(s, 1e-3), -rho, rho);
    return {d,
            table_direction_coordinate(c),
            s,
            x + s * delta,
            std::sqrt(std::max(0.0, ray.rho2 - x * x)),
            std::max(0.0, ray.rho2 + delta * (2 * pn + s2 * delta))};
}

double table_x_of(double X, double d, double c, const EdgeBand& band) {
    const double s = std::sqrt(1 - c * c);
    const EdgeBand base = base_band(c, band);
    double low = X - band.half_width, high = X + band.half_width;  // M moves less than that
    for (int i = 0; i < 50; ++i) {
        const double x = (low + high) / 2;
        (base_coordinate(x, s, d, base) < X ? low : high) = x;
    }
    return (low + high) / 2;
}

double table_extent(const EdgeBand& band) {
    constexpr int kSteps = 32;
    const double R = kKernelRadius;
    double extent = R;
    for (int id = 0; id <= kSteps; ++id) {
        const Edge edge = {(R + band.half_width) * id / kSteps, band};
        for (int iw = -kSteps; iw <= kSteps; ++iw) {
            const double w = R * iw / kSteps, t = unwarped_coordinate(w, edge);
            for (int ic = 0; ic <= kSteps; ++ic) {
                // The border of the support: a circle around n at w, seen at this angle.
                const double c = static_cast<double>(ic) / kSteps, s = std::sqrt(1 - c * c);
                const double x = std::abs(t) * s + std::sqrt(R * R - w * w) * c;
                extent = std::max(extent,
                                  std::abs(base_coordinate(std::copysign(x, t), s, edge.distance, base_band(c, band))));
            }
        }
    }
    return extent * 1.02;  // between two steps
}

}  // namespace edgesplat
