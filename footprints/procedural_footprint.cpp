// The rules of shaders/footprints/footprint.glsl in double precision; keep both in step.
#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

#include "footprints/footprint_integral.h"
#include "footprints/gauss_legendre.h"
#include "footprints/kernel.h"

namespace edgesplat {
namespace {

// The ray, turned so that t increases, with the piece that can reach the kernel.
struct Chord {
    double rho2, pn, un;
    double low,
        high;  // z where the ray is within R of the axis through the voxel along n: W never leaves that cylinder

    Chord(const Ray& ray, const Slice& slice)
        : rho2(ray.rho2), pn(ray.pn), un(std::clamp(std::abs(ray.un), 1e-4, 1.0)) {
        const double s2 = std::max(1 - un * un, 1e-5);
        const double y2 = std::max(0.0, rho2 - pn * pn / s2);
        const double half = std::sqrt(std::max(0.0, kKernelRadius * kKernelRadius - y2) / s2);
        low = std::max(pn * un / s2 - half, ray.un < 0 ? -slice.high : slice.low);
        high = std::max(std::min(pn * un / s2 + half, ray.un < 0 ? -slice.low : slice.high), low);
    }

    double z_of(double t) const { return (t - pn) / un; }
};

// Integral of the warped kernel over the part of the ray with t in [first, last]; `warp` returns w(t).
template <typename Warp>
double piece(const Chord& chord, double first, double last, const QuadratureRule& rule, const Warp& warp) {
    const double start = std::max(chord.z_of(first), chord.low);
    const double length = std::max(0.0, std::min(chord.z_of(last), chord.high) - start);
    double sum = 0;
    for (std::size_t i = 0; i < rule.size(); ++i) {
        const double z = start + length * rule.nodes[i];
        const double t = chord.pn + z * chord.un;
        const double w = warp(t);
        sum += rule.weights[i] * kernel(chord.rho2 + z * z + (w - t) * (w + t));
    }
    return length * sum;
}

// Integral of the plain kernel over the same part.
double plain(const Chord& chord, double first, double last) {
    const auto upto = [&](double t) {
        return kernel_chord(chord.rho2, std::clamp(chord.z_of(t), chord.low, chord.high));
    };
    return upto(last) - upto(first);
}

double whole_plain(const Chord& chord) {
    return kernel_chord(chord.rho2, chord.high) - kernel_chord(chord.rho2, chord.low);
}

// The footprint of the ray's point nearest to the voxel, moved by delta along the part of n that is visible.
double displaced(const Ray& ray, double delta, const Slice& slice) {
    const double s2 = 1 - ray.un * ray.un;
    return sliced_kernel_footprint(std::max(0.0, ray.rho2 + delta * (2 * ray.pn + s2 * delta)), slice);
}

}  // namespace

double sliced_kernel_footprint(double rho2, const Slice& slice, const Kernel& k) {
    return std::max(kernel_chord(rho2, slice.high, k) - kernel_chord(rho2, slice.low, k), 0.0);
}

double procedural_footprint(const Ray& ray, const PaperEdge& edge, int nodes, const Slice& slice) {
    if (nodes != 4 && nodes != 10) throw std::invalid_argument("procedural_footprint: nodes must be 4 or 10");
    const QuadratureRule& rule = kept_gauss_legendre(nodes);
    if (!(edge.distance < kKernelRadius)) return sliced_kernel_footprint(ray.rho2, slice);
    const Chord chord(ray, slice);
    const double start = paper_interval(edge);
    const PaperProfile profile = paper_profile_for(edge);
    const auto warp = [&](double t) { return start + paper_map(t - start, profile); };
    const std::array<double, 4> knots = {start, start + profile.m1, start + profile.m2, start + 1};
    double sum = whole_plain(chord) - plain(chord, start, start + 1);
    for (std::size_t i = 0; i < 3; ++i)
        sum += piece(chord, knots[i], knots[i + 1], rule, warp);
    return std::max(sum, 0.0);
}

double warp2d_footprint(const Ray& ray, const PaperEdge& edge, const Slice& slice) {
    return displaced(ray, warped_coordinate(ray.pn, edge) - ray.pn, slice);
}

}  // namespace edgesplat
