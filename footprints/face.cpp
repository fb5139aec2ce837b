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

/// Voxels along a unit vector with first derivative `slope` >= 0 and second derivative `bend` until -`below` becomes 0.
double way(double below, double slope, double bend) {
    return 2 * below / (slope + std::sqrt(std::max(slope * slope + 2 * below * bend, 0.0)) + 1e-12);
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

/// Whether a point is deeper than what is moved: beyond the plain kernel's reach there is nothing then.
bool is_deep(const FaceRay& ray, const FaceCut& cut, double z) {
    const double phi = ray.phi.at(z), shallow2 = cut.depth * cut.depth * ray.slope2.at(z);
    const double above = phi + cut.thickness;
    return phi < 0 && phi * phi > shallow2 && above > 0 && above * above > shallow2;
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

FacePieces face_pieces(const FaceRay& ray, double thickness) {
    const bool wall = thickness < kInfinity;
    const Roots face = roots(ray.phi, 0);
    const Roots behind = wall ? roots(ray.phi, thickness) : Roots{};
    // Along the ray phi has a least value between its zeros, or a largest.
    const bool opens = ray.phi.a >= 0;
    const Roots everywhere{true, -kInfinity, kInfinity};
    const Roots outer = opens ? face : (wall ? behind : everywhere);
    const Roots inner = opens ? behind : face;
    FacePieces pieces;
    if (!outer.real) return pieces;
    const bool first_behind = !opens && wall;
    pieces.piece[0] = {outer.low, inner.real ? inner.low : outer.high, first_behind};
    pieces.count = 1;
    if (inner.real) {
        pieces.piece[1] = {inner.high, outer.high, opens};
        pieces.count = 2;
    }
    return pieces;
}

double face_kernel(const FaceRay& ray, const FaceCut& cut, double z) {
    const double phi = ray.phi.at(z);
    const double slope = std::sqrt(std::max(ray.slope2.at(z), kLeastSlope2));
    // Where the wall's other face is nearer x is moved the other way.
    double moved = std::min(way(-phi, slope, cut.bend) - cut.depth, 0.0);
    if (cut.thickness < kInfinity) moved += std::max(cut.depth - way(phi + cut.thickness, slope, -cut.bend), 0.0);
    return kernel(std::max(ray.rho2 + z * z + moved * (2 * ray.along.at(z) / slope + moved), 0.0));
}

FaceFootprint face_footprint(const FaceRay& ray, const FaceCut& cut, int nodes, const Slice& slice) {
    FaceFootprint out;
    const double half = std::sqrt(std::max(cut.reach * cut.reach - ray.rho2, 0.0));
    const double plain = std::sqrt(std::max(kKernelRadius * kKernelRadius - ray.rho2, 0.0));
    const double low = std::max(is_deep(ray, cut, -plain) ? -plain : -half, slice.low);
    const double high = std::min(is_deep(ray, cut, plain) ? plain : half, slice.high);
    const FacePieces pieces = face_pieces(ray, cut.thickness);
    const QuadratureRule& rule = rule_of(nodes);
    bool entered = false;
    for (int i = 0; i < pieces.count; ++i) {
        const FacePiece& piece = pieces.piece[static_cast<std::size_t>(i)];
        const double begin = std::max(piece.low, low), end = std::min(piece.high, high);
        if (!(begin < end)) continue;
        double sum = 0;
        for (std::size_t k = 0; k < rule.size(); ++k)
            sum += rule.weights[k] * face_kernel(ray, cut, begin + (end - begin) * rule.nodes[k]);
        out.integral += (end - begin) * sum;
        if (entered) continue;
        entered = true;
        // Slices of a kernel show what its whole shows.
        out.entry = std::clamp(piece.low, -half, half);
        out.from_behind = piece.from_behind && piece.low > -half;
    }
    return out;
}

}  // namespace edgesplat
