#include "footprints/edge_warp.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <span>
#include <stdexcept>

#include "footprints/kernel.h"

namespace edgesplat {
namespace {

// The rational quadratic on [0, 1] with end slopes k and 1.
double rational(double v, double k) {
    return (v * v + k * v * (1 - v)) / (1 + (k - 1) * v * (1 - v));
}

double rational_slope(double v, double k) {
    const double u = 1 - v, d = 1 + (k - 1) * v * u;
    return (k * u * u + 2 * v * u + v * v) / (d * d);
}

double stretched(double s, double a, double k) {
    const double v = std::abs(s) / a;
    return v < 1 ? std::copysign(a * rational(v, k), s) : s;
}

double stretched_slope(double s, double a, double k) {
    const double v = std::abs(s) / a;
    return v < 1 ? rational_slope(v, k) : 1;
}

}  // namespace

double edge_warp(double s, const EdgeBand& band) {
    return stretched(s, band.half_width, band.strength);
}
double edge_warp_slope(double s, const EdgeBand& band) {
    return stretched_slope(s, band.half_width, band.strength);
}

// y (1 + (k-1) v (1-v)) = v^2 + k v (1-v), collected: A v^2 - (A+1) v + y = 0 with A = (k-1)(1-y). The root in [0, 1]
// is written so that nothing cancels; the discriminant is (1-A)^2 + 4A(1-y) >= 0.
double edge_warp_inverse(double w, const EdgeBand& band) {
    const double a = band.half_width, k = band.strength;
    const double y = std::abs(w) / a;
    if (!(y < 1)) return w;
    const double A = (k - 1) * (1 - y);
    const double v = 2 * y / (1 + A + std::sqrt((1 - A) * (1 - A) + 4 * A * (1 - y)));
    return std::copysign(a * v, w);
}

double edge_warp_inverse_slope(double w, const EdgeBand& band) {
    return 1 / edge_warp_slope(edge_warp_inverse(w, band), band);
}

Edge wall_edge(double distance, double second_distance, const EdgeBand& band) {
    const double thickness = distance + second_distance;
    if (!(second_distance < kKernelRadius + band.half_width)) return {distance, band};
    const double fade = std::clamp((thickness - 1) / 0.25, 0.0, 1.0);
    // A wall under one voxel is splatted plainly (k = 1); its band only has to stay positive.
    const double half_width = std::clamp(thickness / 2, 1e-3, band.half_width);
    return {distance, {half_width, 1 + (band.strength - 1) * fade}, second_distance};
}

double warped_coordinate(double t, const Edge& edge) {
    const double s = t - edge.distance;
    double w = t + (edge_warp(s, edge.band) - s);
    if (std::isfinite(edge.second_distance)) {
        const double s2 = t + edge.second_distance;
        w += edge_warp(s2, edge.band) - s2;
    }
    return w;
}

double warped_distance2(double r2, double t, const Edge& edge) {
    if (edge.curvature == 0) {
        const double w = warped_coordinate(t, edge);
        return r2 + (w - t) * (w + t);
    }
    // With q = t - D and e the distance from the axis through the voxel, s = (2q + c(q^2 + e^2)) / (root + 1) is the
    // distance to the sphere and (1 + cq, ce) / root its normal at x; nothing cancels as the curvature c goes to 0.
    const double c = edge.curvature, q = t - edge.distance;
    const double e2 = std::max(r2 - t * t, 0.0);
    const double root = std::sqrt((1 + c * q) * (1 + c * q) + c * c * e2);
    const double s = (2 * q + c * (q * q + e2)) / (root + 1);
    const double moved = edge_warp(s, edge.band) - s;
    const double along = ((1 + c * q) * t + c * e2) / std::max(root, 1e-9);
    return std::max(r2 + moved * (2 * along + moved), 0.0);
}

double unwarped_coordinate(double w, const Edge& edge) {
    // Each face maps its own band onto itself, so w tells which face it belongs to.
    const double s = w - edge.distance;
    double t = w + (edge_warp_inverse(s, edge.band) - s);
    if (std::isfinite(edge.second_distance)) {
        const double s2 = w + edge.second_distance;
        t += edge_warp_inverse(s2, edge.band) - s2;
    }
    return t;
}

Support warped_support(const Edge& edge) {
    // The kernel's ball is the disc |e|^2 = R^2 - w^2 across n at every w in [-R, R]; the warp only moves the disc to
    // t(w).
    constexpr int kSteps = 512;
    const double R = kKernelRadius;
    std::vector<double> t, disc2;
    for (int i = 0; i <= kSteps; ++i) {
        const double w = R * (2.0 * i / kSteps - 1);
        t.push_back(unwarped_coordinate(w, edge));
        disc2.push_back(R * R - w * w);
    }
    const auto radius_about = [&](double shift) {
        double r2 = 0;
        for (std::size_t i = 0; i < t.size(); ++i)
            r2 = std::max(r2, (t[i] - shift) * (t[i] - shift) + disc2[i]);
        return std::sqrt(r2);
    };
    // A maximum of parabolas is convex: narrow the interval by thirds.
    double low = -R - edge.band.half_width, high = -low;
    for (int i = 0; i < 50; ++i) {
        const double third = (high - low) / 3;
        if (radius_about(low + third) < radius_about(high - third))
            high -= third;
        else
            low += third;
    }
    const double shift = (low + high) / 2;
    // The discs between two samples are covered by this margin: t(w) moves at most about 4 voxels per voxel.
    const double margin = 1e-4;
    return {shift, radius_about(shift) + margin, radius_about(0) + margin};
}

std::vector<Support> warped_support_table(const EdgeBand& band, int entries) {
    if (entries < 2) throw std::invalid_argument("warped_support_table: entries must be at least 2");
    const double reach = kKernelRadius + band.half_width;
    std::vector<Support> table;
    table.reserve(static_cast<std::size_t>(entries));
    for (int i = 0; i < entries; ++i)
        table.push_back(warped_support({reach * (2.0 * i / (entries - 1) - 1), band}));
    return table;
}

std::vector<Support> covering_supports(const EdgeBand& band, int cells) {
    if (cells < 1) throw std::invalid_argument("covering_supports: cells must be at least 1");
    constexpr int kPerCell = 4;
    const double step = (kKernelRadius + band.half_width) / (cells * kPerCell);
    std::vector<Support> spheres;
    for (int i = 0; i < cells; ++i) {
        std::vector<Support> inside;
        for (int j = 0; j <= kPerCell; ++j)
            inside.push_back(warped_support({step * (i * kPerCell + j), band}));
        const auto [least, most] =
            std::ranges::minmax_element(inside, {}, [](const Support& support) { return support.shift; });
        Support cover = {(least->shift + most->shift) / 2, 0, 0};
        for (const Support& support : inside) {
            cover.radius = std::max(cover.radius, support.radius + std::abs(support.shift - cover.shift));
            cover.radius_about_voxel = std::max(cover.radius_about_voxel, support.radius_about_voxel);
        }
        // Where the edge only just reaches the kernel the support grows fast; between two samples by at most this.
        cover.radius += step / 2;
        cover.radius_about_voxel += step;
        spheres.push_back(cover);
    }
    return spheres;
}

namespace {

/// Least half-axis across n with which a spheroid of that centre and half-axis along n holds the rims (t, e); infinite
/// where one lies beyond it, or the square of the half-axis exceeds `most2`. The rim that says so comes first then,
/// since it will say so of the next spheroid as well.
double half_axis_across(std::span<std::array<double, 2>> rims, double shift, double along, double most2) {
    double across2 = 0;
    for (auto& rim : rims) {
        const auto [t, e] = rim;
        const double u = (t - shift) / along, rest = 1 - u * u;
        across2 = rest > 0 ? std::max(across2, e * e / rest) : std::numeric_limits<double>::infinity();
        if (across2 > most2) {
            std::swap(rim, rims.front());
            return std::numeric_limits<double>::infinity();
        }
    }
    return std::sqrt(across2);
}

Spheroid smallest_spheroid(std::span<std::array<double, 2>> rims) {
    const auto [low, high] = std::ranges::minmax(rims, {}, [](const auto& rim) { return rim[0]; });
    const double middle = (low[0] + high[0]) / 2, half = (high[0] - low[0]) / 2;
    Spheroid best;
    double least = std::numeric_limits<double>::infinity();
    for (int i = -20; i <= 20; ++i) {
        for (int j = 1; j <= 40; ++j) {
            const double shift = middle + 0.02 * i * half, along = half * (1 + 0.02 * std::abs(i)) + 0.02 * j * half;
            // About what it covers of the screen, seen from anywhere, is across (across + along).
            const double most = (std::sqrt(along * along + 4 * least) - along) / 2;
            const double across = half_axis_across(rims, shift, along, most * most * (1 + 1e-9));
            if (const double cover = across * (across + along); cover < least) {
                least = cover;
                best = {shift, along, across};
            }
        }
    }
    return best;
}

}  // namespace

std::vector<Spheroid> covering_spheroids(const EdgeBand& band, int cells) {
    if (cells < 1) throw std::invalid_argument("covering_spheroids: cells must be at least 1");
    constexpr int kPerCell = 4, kRims = 96;
    const double R = kKernelRadius, step = (R + band.half_width) / (cells * kPerCell);
    // The kernel's ball as discs across n, evenly spaced in angle: between two of them it bulges, between two distances
    // they move.
    const double margin = 2e-3 + step / 2;
    std::vector<Spheroid> out;
    std::vector<std::array<double, 2>> rims;
    for (int cell = 0; cell < cells; ++cell) {
        rims.clear();
        for (int i = 0; i <= kRims * (kPerCell + 1); ++i) {
            const Edge edge{step * (cell * kPerCell + i % (kPerCell + 1)), band};
            const double angle = std::numbers::pi * (i / (kPerCell + 1)) / kRims;
            rims.push_back({unwarped_coordinate(R * std::cos(angle), edge), R * std::sin(angle)});
        }
        Spheroid spheroid = smallest_spheroid(rims);
        spheroid.along += margin;
        spheroid.across += margin;
        out.push_back(spheroid);
    }
    return out;
}

std::vector<Support> covering_supports_of_curved(const EdgeBand& band, int cells) {
    if (cells < 1) throw std::invalid_argument("covering_supports_of_curved: cells must be at least 1");
    const double step = (kKernelRadius + band.half_width) / cells;
    constexpr int kSteps = 256;
    std::vector<Support> spheres;
    for (int i = 0; i < cells; ++i) {
        // A point of the ball lies at a distance s from the edge with |s + D| <= R, D anywhere in the cell.
        const double low = -step * (i + 1) - kKernelRadius, high = -step * i + kKernelRadius;
        double farthest = 0;
        for (int j = 0; j <= kSteps; ++j) {
            const double s = low + (high - low) * j / kSteps;
            farthest = std::max(farthest, std::abs(edge_warp_inverse(s, band) - s));
        }
        const double radius = kKernelRadius + farthest + (high - low) / kSteps;
        spheres.push_back({0, radius, radius});
    }
    return spheres;
}

double largest_support_radius(const EdgeBand& band) {
    double radius = kKernelRadius;
    for (const Support& support : warped_support_table(band, 129))
        radius = std::max(radius, support.radius_about_voxel);
    return radius + 1e-3;  // between two entries
}

}  // namespace edgesplat
