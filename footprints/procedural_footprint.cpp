// The rules that shaders/lib/footprint.glsl computes, in double precision: keep the two alike.
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <stdexcept>
#include <utility>

#include "footprints/footprint_integral.h"
#include "footprints/gauss_legendre.h"
#include "footprints/kernel.h"

namespace edgesplat {
namespace {

const QuadratureRule& rule_of(int nodes) {
    static const std::map<int, QuadratureRule> rules = [] {
        std::map<int, QuadratureRule> all;
        for (int n : {4, 6, 10, 12, 16})
            all.emplace(n, gauss_legendre(n));
        all.emplace(8, crowded(gauss_legendre(8)));
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

// Integral of the warped kernel over the part of the ray with t in [first, last], where `warp` gives w(t). The rule's
// nodes are counted from its first end on or, `from_last`, from its last.
template <typename Warp>
double piece(const Chord& chord, double first, double last, const QuadratureRule& rule, const Warp& warp,
             bool from_last = false) {
    const double start = std::max(chord.z_of(first), chord.low);
    const double length = std::max(0.0, std::min(chord.z_of(last), chord.high) - start);
    double sum = 0;
    for (std::size_t i = 0; i < rule.size(); ++i) {
        const double z = start + length * (from_last ? 1 - rule.nodes[i] : rule.nodes[i]);
        const double t = chord.pn + z * chord.un;
        const double w = warp(t);
        sum += rule.weights[i] * kernel(chord.rho2 + z * z + (w - t) * (w + t));
    }
    return length * sum;
}

// The plain kernel over the same part.
double plain(const Chord& chord, double first, double last) {
    const auto upto = [&](double t) {
        return kernel_chord(chord.rho2, std::clamp(chord.z_of(t), chord.low, chord.high));
    };
    return upto(last) - upto(first);
}

double whole_plain(const Chord& chord) {
    return kernel_chord(chord.rho2, chord.high) - kernel_chord(chord.rho2, chord.low);
}

// What one face changes: its band, warped instead of plain.
double band_change(const Chord& chord, double face, const EdgeBand& band, const QuadratureRule& rule) {
    // w in [-R, R] is all the kernel there is.
    const double first = std::max(face - band.half_width, face + edge_warp_inverse(-kKernelRadius - face, band));
    const double last = std::min(face + band.half_width, face + edge_warp_inverse(kKernelRadius - face, band));
    const auto warp = [&](double t) { return face + edge_warp(t - face, band); };
    return piece(chord, first, face, rule, warp, true) + piece(chord, face, last, rule, warp) -
           plain(chord, face - band.half_width, face + band.half_width);
}

// The footprint of the point where the ray passes nearest to the voxel, moved by delta along n as far as one can see
// it.
double displaced(const Ray& ray, double delta, const Slice& slice) {
    const double s2 = 1 - ray.un * ray.un;
    return sliced_kernel_footprint(std::max(0.0, ray.rho2 + delta * (2 * ray.pn + s2 * delta)), slice);
}

// Where a ray is within a distance s of a curved edge: A z^2 + 2 B z + C(s) = 0 at its ends.
struct Parabola {
    double A, B, C;  // C(0)

    Parabola(const Ray& ray, const Edge& edge)
        : A(std::abs(edge.curvature) < 1e-5 ? std::copysign(1e-5, edge.curvature) : edge.curvature),
          B(ray.un * (1 - A * edge.distance)),
          C(2 * (ray.pn - edge.distance) +
            A * (ray.rho2 - 2 * ray.pn * edge.distance + edge.distance * edge.distance)) {}

    double vertex() const { return -B / A; }

    // The two z at signed distance s; both the vertex where the ray does not come as near (or as far).
    std::pair<double, double> at(double s) const {
        const double c = C - s * (2 + A * s);
        const double disc = B * B - A * c;
        if (!(disc > 0)) return {vertex(), vertex()};
        const double q = -(B + std::copysign(std::sqrt(disc), B));
        const double first = q / A, second = q == 0 ? first : c / q;
        return std::minmax(first, second);
    }
};

double curved_footprint(const Ray& ray, const Edge& edge, const QuadratureRule& rule, const Slice& slice) {
    // W moves no point further than the band is wide, so a kernel reaches no further than this.
    const double reach = kKernelRadius + edge.band.half_width;
    const double half = std::sqrt(std::max(0.0, reach * reach - ray.rho2));
    const double low = std::max(-half, slice.low), high = std::max(std::min(half, slice.high), low);
    const auto upto = [&](double z) { return kernel_chord(ray.rho2, z); };
    double sum = upto(high) - upto(low);
    const Parabola parabola(ray, edge);
    // Outside these distances W leads out of the kernel.
    const double inner = std::max(-edge.band.half_width, edge_warp_inverse(-kKernelRadius - edge.distance, edge.band));
    const double outer = std::min(edge.band.half_width, edge_warp_inverse(kKernelRadius - edge.distance, edge.band));
    const auto clip = [&](double z) { return std::clamp(z, low, high); };
    // Every half band is met twice: on the way in and on the way out.
    const auto change = [&](double from, double to, double quadrature_from, double quadrature_to) {
        const auto [a0, a1] = parabola.at(from);
        const auto [b0, b1] = parabola.at(to);
        for (const auto& [x, y] : {std::minmax({clip(a0), clip(b0)}), std::minmax({clip(a1), clip(b1)})})
            sum -= upto(y) - upto(x);
        if (!(quadrature_from < quadrature_to)) return;
        const auto [c0, c1] = parabola.at(quadrature_from);
        const auto [d0, d1] = parabola.at(quadrature_to);
        for (const auto& [x, y] : {std::minmax({clip(c0), clip(d0)}), std::minmax({clip(c1), clip(d1)})}) {
            double part = 0;
            for (std::size_t i = 0; i < rule.size(); ++i) {
                const double z = x + (y - x) * rule.nodes[i];
                part += rule.weights[i] * kernel(warped_distance2(ray.rho2 + z * z, ray.pn + z * ray.un, edge));
            }
            sum += (y - x) * part;
        }
    };
    change(-edge.band.half_width, 0, inner, 0);
    change(0, edge.band.half_width, 0, outer);
    return std::max(sum, 0.0);
}

}  // namespace

double sliced_kernel_footprint(double rho2, const Slice& slice) {
    return std::max(kernel_chord(rho2, slice.high) - kernel_chord(rho2, slice.low), 0.0);
}

double procedural_footprint(const Ray& ray, const Edge& edge, int nodes, const Slice& slice) {
    const QuadratureRule& rule = rule_of(nodes);
    if (edge.curvature != 0) return curved_footprint(ray, edge, rule, slice);
    // Walls under a voxel are left as they are (wall_edge).
    if (edge.band.strength == 1) return sliced_kernel_footprint(ray.rho2, slice);
    const Chord chord(ray, slice);
    double sum = whole_plain(chord);
    sum += band_change(chord, edge.distance, edge.band, rule);
    if (std::isfinite(edge.second_distance)) sum += band_change(chord, -edge.second_distance, edge.band, rule);
    return std::max(sum, 0.0);
}

double procedural_footprint(const Ray& ray, const PaperEdge& edge, int nodes, const Slice& slice) {
    const QuadratureRule& rule = rule_of(nodes);
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

double warp2d_footprint(const Ray& ray, const Edge& edge, const Slice& slice) {
    return displaced(ray, warped_coordinate(ray.pn, edge) - ray.pn, slice);
}

double warp2d_footprint(const Ray& ray, const PaperEdge& edge, const Slice& slice) {
    return displaced(ray, warped_coordinate(ray.pn, edge) - ray.pn, slice);
}

}  // namespace edgesplat
