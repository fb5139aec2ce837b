#include "footprints/face.h"

#include <algorithm>
#include <cmath>

#include "footprints/gauss_legendre.h"

namespace edgesplat {

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
// Below this curvature phi counts as linear along a ray: its second zero is out of every kernel's reach.
constexpr double kStraight = 1e-6;
constexpr double kLeastSlope2 = 1e-8;
constexpr double kNowhere = 1e9;  // voxels along a ray: out of every kernel's reach, but finite

/// A face that bounds the matter, and its direction.
struct End {
    double level = 0;  ///< phi = -level
    double side = 1;   ///< -1: matter lies where phi is larger
};

/// The tangent plane where a ray meets that face at z. If z is at the end of the reach, the face may be further away;
/// then the plane lies at the distance to the face from there.
FacePlane plane_at(const FaceRay& ray, double depth, double z, const End& end) {
    const double slope = std::sqrt(std::max(ray.slope2.at(z), kLeastSlope2));
    const double p = end.side * (ray.across + z * ray.turn) / slope;
    const double u = end.side * (ray.phi.b + 2 * z * ray.phi.a) / slope;
    const double distance = end.side * (ray.phi.at(z) + end.level) / slope;
    return {p, u, p + z * u - distance - depth};
}

double reach2_of(double distance, double depth, double norm, double radius) {
    const double off = distance - depth;
    if (!(std::abs(off) < radius)) return 0;
    // Normals turn by `norm` per voxel, which spreads the points that are moved along them; and the face leaves its
    // tangent plane.
    const double lateral = std::sqrt(radius * radius - off * off) * (1 + 1.2 * depth * norm);
    const double along = std::max(distance, 0.0) + 0.5 * norm * lateral * lateral;
    return lateral * lateral + along * along;
}

/// Where a ray enters and leaves the part of space inside all planes, and through which plane (FaceEnd::plane).
struct PlaneEnds {
    double low = -kInfinity, high = kInfinity;
    int low_plane = 0, high_plane = 0;
    void cut(const FaceRay::Crease& ray, double distance, int plane) {
        const double way = std::abs(ray.u) < kStraight ? std::copysign(kStraight, ray.u) : ray.u;
        const double z = (distance - ray.p) / way;
        if (way < 0 && z > low) low = z, low_plane = plane;
        if (way > 0 && z < high) high = z, high_plane = plane;
    }
};

}  // namespace

FaceRoots face_roots(const Quadratic& phi, double level) {
    const double c = phi.c + level;
    const double a = std::abs(phi.a) < kStraight ? std::copysign(kStraight, phi.a) : phi.a;
    const double disc = phi.b * phi.b - 4 * a * c;
    if (!(disc >= 0)) return {};
    const double q = -0.5 * (phi.b + (phi.b < 0 ? -std::sqrt(disc) : std::sqrt(disc)));
    const double far = q / a;
    const double near = q != 0 ? c / q : far;
    return {true, std::min(near, far), std::max(near, far)};
}

FaceCut face_cut(double distance, double bend, double norm, double thickness, double deepest, const Kernel& kernel) {
    const double radius = kernel.radius;
    FaceCut cut;
    cut.kernel = &kernel;
    cut.depth = deepest;
    cut.thickness = thickness;
    // If the face bends away on both sides, the ridge, where the slope is 0, limits the depth.
    if (bend > 0) cut.depth = std::min(cut.depth, 0.5 / bend);
    cut.depth = std::min(cut.depth, 0.5 * thickness);
    double reach2 = std::max(radius * radius, reach2_of(distance, cut.depth, norm, radius));
    if (thickness < kInfinity) reach2 = std::max(reach2, reach2_of(thickness - distance, cut.depth, norm, radius));
    // No point is moved by more than `depth`.
    cut.reach = std::min(std::sqrt(reach2), radius + cut.depth);
    return cut;
}

void add_crease(FaceCut& cut, const FaceCut::Crease& crease, double corner) {
    if (!(crease.distance < cut.kernel->radius + cut.depth)) return;
    cut.crease = crease;
    cut.corner = corner;
    // Points that both moves bring into the kernel may come from this far.
    const double further = std::max((2 * crease.distance - cut.depth) * cut.depth, 0.0);
    cut.reach = std::min(std::sqrt(cut.reach * cut.reach + further), kFaceFarthest);
}

double FacePlane::beyond(double z) const {
    const double t = at(z), held = std::min(t, level);
    return z * z - t * t + held * held;
}

FacePath::FacePath(const FaceRay& ray, const FaceCut& cut, FacePieces choice)
    : kernel_(cut.kernel),
      rho2_(ray.rho2),
      half_chord_(std::sqrt(std::max(cut.reach * cut.reach - ray.rho2, 0.0))),
      crease_{ray.crease.p, ray.crease.u, cut.crease.distance - cut.depth},
      facing_(cut.crease.facing),
      phi_(ray.phi),
      thickness_(cut.thickness) {
    const bool wall = cut.thickness < kInfinity;
    const FaceRoots face = face_roots(ray.phi, 0);
    const FaceRoots behind = wall ? face_roots(ray.phi, cut.thickness) : FaceRoots{};
    // On the ray phi has a minimum between its zeros, or a maximum.
    const bool opens = ray.phi.a >= 0;
    const FaceRoots everywhere{true, -kNowhere, kNowhere};
    const FaceRoots outer = opens ? face : (wall ? behind : everywhere);
    const FaceRoots inner = opens ? behind : face;
    if (!outer.real) return;
    PlaneEnds ends;
    ends.cut(ray.crease, cut.crease.distance, 1);
    ends.cut(ray.corner, cut.corner, 2);
    const End front, back{cut.thickness, -1};
    const End outer_end = opens || !wall ? front : back, inner_end = opens ? back : front;
    const auto add = [&](double low, double high, const End& entry, const End& leave) {
        // A ray that meets no face is nearest to it at phi's extremum.
        const bool meets = low > -kNowhere || high < kNowhere;
        const double turn = -0.5 * ray.phi.b / std::min(ray.phi.a, -kStraight);
        const auto held = [this](double z) { return std::clamp(z, -half_chord_, half_chord_); };
        const double from = std::max(low, ends.low);
        pieces_.at(count_++) = {from,
                                std::max(std::min(high, ends.high), from),
                                ends.low > low ? ends.low_plane : 0,
                                ends.high < high ? ends.high_plane : 0,
                                plane_at(ray, cut.depth, held(meets ? low : turn), entry),
                                plane_at(ray, cut.depth, held(meets ? high : turn), leave)};
    };
    add(outer.low, inner.real ? inner.low : outer.high, outer_end, inner.real ? inner_end : outer_end);
    if (!inner.real) return;
    add(inner.high, outer.high, inner_end, outer_end);
    if (choice == FacePieces::Both) return;
    if (!(overlap(pieces_[0]) > overlap(pieces_[1]))) pieces_[0] = pieces_[1];
    count_ = 1;
}

double FacePath::overlap(const FacePiece& piece) const {
    return std::min(piece.high, half_chord_) - std::max(piece.low, -half_chord_);
}

FaceEnd FacePath::end_at(double z, int plane) const {
    const double held = std::clamp(z, -half_chord_, half_chord_);
    return {held, plane == 0 && phi_.at(held) < -kBesideOther * thickness_, plane};
}

double FacePath::sampled_at(const FacePiece& piece, double z) const {
    const FacePlane& plane = piece.plane(z);
    const double moved = std::min(plane.level - plane.at(z), 0.0);
    const double t = crease_.at(z) + moved * facing_, held = std::min(t, crease_.level);
    return std::max(rho2_ + plane.beyond(z) + held * held - t * t, 0.0);
}

double FacePath::kernel_at(double z) const {
    if (!(std::abs(z) < half_chord_)) return 0;
    for (const FacePiece& piece : pieces())
        if (z >= piece.low && z <= piece.high) return kernel(sampled_at(piece, z), *kernel_);
    return 0;
}

FaceFootprint FacePath::footprint(int nodes, const Slice& slice) const {
    FaceFootprint out;
    const double plain = std::sqrt(std::max(kernel_->radius * kernel_->radius - rho2_, 0.0));
    const QuadratureRule& rule = kept_gauss_legendre(nodes);
    // Below the depth at which points are moved, the kernel ends at the plain kernel's reach. In a wall no point may be
    // moved all the way, since its other face may be tilted.
    const double far = thickness_ < kInfinity ? half_chord_ : plain;
    const auto deep = [&](const FacePlane& plane, double side) {
        return plane.is_deep(side * plain, side * far) && crease_.is_deep(side * plain, side * far);
    };
    for (const FacePiece& piece : pieces()) {
        const double low = deep(piece.entry, -1) ? -plain : -half_chord_;
        const double high = deep(piece.leave, 1) ? plain : half_chord_;
        const double begin = std::max({piece.low, low, slice.low}), end = std::min({piece.high, high, slice.high});
        double sum = 0;
        for (std::size_t k = 0; begin < end && k < rule.size(); ++k) {
            const double z = begin + (end - begin) * rule.nodes[k];
            sum += rule.weights[k] * kernel(sampled_at(piece, z), *kernel_);
        }
        out.integral += std::max(end - begin, 0.0) * sum;
        // All slices of a kernel show what the whole kernel shows, so the entry is that of the first piece within its
        // reach, else of the last. Where a ray only touches a face, its path splits in two; leaving by the last piece
        // avoids a jump.
        const bool first = &piece == &pieces().front(), last = &piece == &pieces().back();
        if (first ? last || overlap(piece) > 0 : !(overlap(pieces().front()) > 0))
            out.entry = end_at(piece.low, piece.from_plane);
        if (first || overlap(piece) > 0 || !(overlap(pieces().front()) > 0))
            out.leave = end_at(piece.high, piece.to_plane);
    }
    return out;
}

}  // namespace edgesplat
