// The rules that shaders/lib/footprint.glsl computes, in double precision: keep the two alike.
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <stdexcept>

#include "footprints/footprint_integral.h"
#include "footprints/gauss_legendre.h"
#include "footprints/kernel.h"

namespace edgesplat {
namespace {

const QuadratureRule& rule_of(int nodes) {
    static const std::map<int, QuadratureRule> rules = [] {
        std::map<int, QuadratureRule> all;
        for (int n : {4, 6, 8, 10, 12, 16})
            all.emplace(n, gauss_legendre(n));
        return all;
    }();
    const auto found = rules.find(nodes);
    if (found == rules.end()) throw std::invalid_argument("procedural_footprint: nodes must be 4, 6, 8, 10, 12 or 16");
    return found->second;
}

// The ray as the rule sees it: turned so that t increases, with the piece of it that can reach the kernel.
struct Chord {
    double rho2, pn, un;
    double low,
        high;  // z where the ray is within R of the axis through the voxel along n: W never leaves that cylinder

    explicit Chord(const Ray& ray) : rho2(ray.rho2), pn(ray.pn), un(std::clamp(std::abs(ray.un), 1e-4, 1.0)) {
        const double s2 = std::max(1 - un * un, 1e-5);
        const double y2 = std::max(0.0, rho2 - pn * pn / s2);
        const double half = std::sqrt(std::max(0.0, kKernelRadius * kKernelRadius - y2) / s2);
        low = pn * un / s2 - half;
        high = pn * un / s2 + half;
    }

    double z_of(double t) const { return (t - pn) / un; }
};

// Integral of the warped kernel over the part of the ray with t in [first, last], where `warp` gives w(t).
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

double plain(const Chord& chord, double first, double last) {
    return kernel_chord(chord.rho2, chord.z_of(last)) - kernel_chord(chord.rho2, chord.z_of(first));
}

// What one face changes: its band, warped instead of plain.
double band_change(const Chord& chord, double face, const EdgeBand& band, const QuadratureRule& rule) {
    // w in [-R, R] is all the kernel there is.
    const double first = std::max(face - band.half_width, face + edge_warp_inverse(-kKernelRadius - face, band));
    const double last = std::min(face + band.half_width, face + edge_warp_inverse(kKernelRadius - face, band));
    const auto warp = [&](double t) { return face + edge_warp(t - face, band); };
    return piece(chord, first, face, rule, warp) + piece(chord, face, last, rule, warp) -
           plain(chord, face - band.half_width, face + band.half_width);
}

// The footprint of the point where the ray passes nearest to the voxel, moved by delta along n as far as one can see
// it.
double displaced(const Ray& ray, double delta) {
    const double s2 = 1 - ray.un * ray.un;
    return kernel_footprint(std::max(0.0, ray.rho2 + delta * (2 * ray.pn + s2 * delta)));
}

}  // namespace

double procedural_footprint(const Ray& ray, const Edge& edge, int nodes) {
    const QuadratureRule& rule = rule_of(nodes);
    const Chord chord(ray);
    double sum = kernel_footprint(ray.rho2);
    sum += band_change(chord, edge.distance, edge.band, rule);
    if (std::isfinite(edge.second_distance)) sum += band_change(chord, -edge.second_distance, edge.band, rule);
    return std::max(sum, 0.0);
}

double procedural_footprint(const Ray& ray, const PaperEdge& edge, int nodes) {
    const QuadratureRule& rule = rule_of(nodes);
    const double g = kernel_footprint(ray.rho2);
    if (!(edge.distance < kKernelRadius)) return g;
    const Chord chord(ray);
    const double start = paper_interval(edge);
    const PaperProfile profile = paper_profile_for(edge);
    const auto warp = [&](double t) { return start + paper_map(t - start, profile); };
    const std::array<double, 4> knots = {start, start + profile.m1, start + profile.m2, start + 1};
    double sum = g - plain(chord, start, start + 1);
    for (std::size_t i = 0; i < 3; ++i)
        sum += piece(chord, knots[i], knots[i + 1], rule, warp);
    return std::max(sum, 0.0);
}

double warp2d_footprint(const Ray& ray, const Edge& edge) {
    return displaced(ray, warped_coordinate(ray.pn, edge) - ray.pn);
}

double warp2d_footprint(const Ray& ray, const PaperEdge& edge) {
    return displaced(ray, warped_coordinate(ray.pn, edge) - ray.pn);
}

}  // namespace edgesplat
