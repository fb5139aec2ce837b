#include "footprints/face.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "footprints/gauss_legendre.h"

namespace edgesplat {

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
// Where phi is this nearly linear along a ray, its second zero lies out of every kernel's reach.
constexpr double kStraight = 1e-6;
constexpr double kLeastSlope2 = 1e-8;
constexpr double kFar = 1e3;  // voxels: a face that a ray meets further off is not met

struct Roots {
    bool real = false;
    double low = 0, high = 0;
};

/// Where phi = -level. No root loses digits to cancellation.
Roots roots(const Quadratic& phi, double level) {
    const double c = phi.c + level;
    const double a = std::abs(phi.a) < kStraight ? std::copysign(kStraight, phi.a) : phi.a;
    const double disc = phi.b * phi.b - 4 * a * c;
    if (!(disc >= 0)) return {};
    const double q = -0.5 * (phi.b + (phi.b < 0 ? -std::sqrt(disc) : std::sqrt(disc)));
    const double far = q / a;
    const double near = q != 0 ? c / q : far;
    return {true, std::min(near, far), std::max(near, far)};
}

/// Where a ray meets a face at z. `out_along`: 1 where it leaves there, -1 where it enters.
FacePlane plane_at(const FaceRay& ray, double depth, double z, double out_along) {
    if (!(std::abs(z) < kFar)) return {};
    const double slope = std::sqrt(std::max(ray.slope2.at(z), kLeastSlope2));
    const double p = (ray.across + z * ray.turn) / slope, u = (ray.phi.b + 2 * z * ray.phi.a) / slope;
    const double side = u * out_along < 0 ? -1 : 1;
    return {side * p, side * u, side * (p + z * u) - depth};
}

const QuadratureRule& rule_of(int nodes) {
    static const std::map<int, QuadratureRule> rules = [] {
        std::map<int, QuadratureRule> made;
        for (int n = 1; n <= 32; ++n)
            made.emplace(n, gauss_legendre(n));
        return made;
    }();
    return rules.at(nodes);
}

double reach2_of(double distance, double depth, double norm) {
    const double off = distance - depth;
    if (!(std::abs(off) < kKernelRadius)) return 0;
    // Normals turn by `norm` a voxel, which spreads what is moved along them, and the face leaves its tangent plane.
    const double lateral = std::sqrt(kKernelRadius * kKernelRadius - off * off) * (1 + 1.2 * depth * norm);
    const double along = std::max(distance, 0.0) + 0.5 * norm * lateral * lateral;
    return lateral * lateral + along * along;
}

}  // namespace

FaceCut face_cut(double distance, double bend, double norm, double thickness) {
    FaceCut cut;
    cut.bend = bend;
    cut.thickness = thickness;
    // What is bent away from both sides is as deep as the ridge, where the slope is 0.
    if (bend > 0) cut.depth = std::min(cut.depth, 0.5 / bend);
    cut.depth = std::min(cut.depth, 0.5 * thickness);
    double reach2 = std::max(kKernelRadius * kKernelRadius, reach2_of(distance, cut.depth, norm));
    if (thickness < kInfinity) reach2 = std::max(reach2, reach2_of(thickness - distance, cut.depth, norm));
    // No point is moved further than that.
    cut.reach = std::min(std::sqrt(reach2), kKernelRadius + cut.depth);
    return cut;
}

double FacePlane::beyond(double z) const {
    const double t = at(z), held = std::min(t, level);
    return z * z - t * t + held * held;
}

FacePath::FacePath(const FaceRay& ray, const FaceCut& cut, FacePieces choice)
    : rho2_(ray.rho2), half_chord_(std::sqrt(std::max(cut.reach * cut.reach - ray.rho2, 0.0))) {
    const bool wall = cut.thickness < kInfinity;
    const Roots face = roots(ray.phi, 0);
    const Roots behind = wall ? roots(ray.phi, cut.thickness) : Roots{};
    // Along the ray phi has a least value between its zeros, or a largest.
    const bool opens = ray.phi.a >= 0;
    const Roots everywhere{true, -kInfinity, kInfinity};
    const Roots outer = opens ? face : (wall ? behind : everywhere);
    const Roots inner = opens ? behind : face;
    if (!outer.real) return;
    const auto add = [&](double low, double high, bool from_behind) {
        pieces_.at(count_++) = {low, high, from_behind, plane_at(ray, cut.depth, low, -1),
                                plane_at(ray, cut.depth, high, 1)};
    };
    add(outer.low, inner.real ? inner.low : outer.high, !opens && wall);
    if (!inner.real) return;
    add(inner.high, outer.high, opens);
    if (choice == FacePieces::Both) return;
    if (!(overlap(pieces_[0]) > overlap(pieces_[1]))) pieces_[0] = pieces_[1];
    count_ = 1;
}

double FacePath::overlap(const FacePiece& piece) const {
    return std::min(piece.high, half_chord_) - std::max(piece.low, -half_chord_);
}

double FacePath::kernel_at(double z) const {
    if (!(std::abs(z) < half_chord_)) return 0;
    for (const FacePiece& piece : pieces())
        if (z >= piece.low && z <= piece.high) return kernel(std::max(rho2_ + piece.plane(z).beyond(z), 0.0));
    return 0;
}

FaceFootprint FacePath::footprint(int nodes, const Slice& slice) const {
    FaceFootprint out;
    const double plain = std::sqrt(std::max(kKernelRadius * kKernelRadius - rho2_, 0.0));
    const QuadratureRule& rule = rule_of(nodes);
    for (const FacePiece& piece : pieces()) {
        // Deeper than what is moved there is nothing beyond the plain kernel's reach.
        const double low = piece.entry.is_deep(-plain) ? -plain : -half_chord_;
        const double high = piece.leave.is_deep(plain) ? plain : half_chord_;
        const double begin = std::max({piece.low, low, slice.low}), end = std::min({piece.high, high, slice.high});
        double sum = 0;
        for (std::size_t k = 0; begin < end && k < rule.size(); ++k) {
            const double z = begin + (end - begin) * rule.nodes[k];
            sum += rule.weights[k] * kernel(std::max(rho2_ + piece.plane(z).beyond(z), 0.0));
        }
        out.integral += std::max(end - begin, 0.0) * sum;
        // Slices of a kernel show what its whole shows: the first piece within its reach, else the last.
        if (&piece != &pieces().back() && !(overlap(piece) > 0)) continue;
        if (&piece != &pieces().front() && overlap(pieces().front()) > 0) continue;
        out.entry = std::clamp(piece.low, -half_chord_, half_chord_);
        out.from_behind = piece.from_behind && piece.low > -half_chord_;
    }
    return out;
}

}  // namespace edgesplat
