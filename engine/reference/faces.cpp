#include "engine/reference/faces.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <span>

#include "engine/reference/creases.h"
#include "engine/reference/quadrics.h"
#include "shaders/shared/limits.h"

namespace edgesplat::reference {

namespace {

using glm::dmat3;
using glm::dvec3;

// Constants shared with the shaders.
constexpr auto kFitRadius = static_cast<double>(shader::FIT_RADIUS);
constexpr auto kFaceSearch = static_cast<double>(shader::FACE_SEARCH);
constexpr auto kThinnest = static_cast<double>(shader::FIT_THINNEST);
constexpr auto kOwnShare = static_cast<double>(shader::FIT_OWN);
constexpr auto kBadly = static_cast<double>(shader::FIT_BADLY);
constexpr auto kWell = static_cast<double>(shader::FIT_WELL);
constexpr auto kWallShare = static_cast<double>(shader::FIT_WALL);
constexpr auto kWallLevel = static_cast<double>(shader::WALL_LEVEL);
constexpr auto kWallTilted = static_cast<double>(shader::WALL_TILTED);
constexpr auto kTurnFrom = static_cast<double>(shader::TURN_FROM);
constexpr auto kWallBent = static_cast<double>(shader::WALL_BENT);

double surfel_weight(const dvec3& r, const dvec3& n, const dvec3& other) {
    const double along = glm::dot(r, n);
    const double shorter = 1 - 0.5 * std::clamp(-2 * glm::dot(n, other), 0.0, 1.0);
    const double w = 1 - (glm::dot(r, r) - along * along * (1 - shorter * shorter)) / (kFitRadius * kFitRadius);
    return std::max(w, 0.0) * std::max(w, 0.0);
}

/// The second-order expansion of the field around voxel i (docs/method/faces.md, 5): negative on the voxel's side of
/// `iso`, with a slope of about 1 where it is 0. Second: the field's slope there.
std::pair<Quadric, double> field_quadric(const Field& field, const glm::ivec3& i, double iso, double side) {
    const auto at = [&](int x, int y, int z) { return field.at(i + glm::ivec3(x, y, z)); };
    const double f = at(0, 0, 0), off = iso - f;
    const dvec3 low(at(-1, 0, 0), at(0, -1, 0), at(0, 0, -1)), high(at(1, 0, 0), at(0, 1, 0), at(0, 0, 1));
    const dvec3 g = 0.5 * (high - low), diagonal = high - 2 * f + low;
    const double yz = 0.25 * (at(0, 1, 1) - at(0, 1, -1) - at(0, -1, 1) + at(0, -1, -1));
    const double xz = 0.25 * (at(1, 0, 1) - at(1, 0, -1) - at(-1, 0, 1) + at(-1, 0, -1));
    const double xy = 0.25 * (at(1, 1, 0) - at(1, -1, 0) - at(-1, 1, 0) + at(-1, -1, 0));
    const double norm = std::sqrt(glm::dot(diagonal, diagonal) + 2 * (yz * yz + xz * xz + xy * xy));
    const double slope = std::sqrt(std::max(glm::dot(g, g) + 2 * std::abs(off) * norm, 1e-12)), scale = side / slope;
    return {{scale * off, -scale * g, -scale * dmat3(diagonal.x, xy, xz, xy, diagonal.y, yz, xz, yz, diagonal.z)},
            slope};
}

/// The same for the field's own quadric around the voxel.
Foot own_foot_of(const Quadric& q) {
    const dvec3 d(q.h[0][0], q.h[1][1], q.h[2][2]);
    dvec3 way = q.g;
    way[d.x >= d.y && d.x >= d.z ? 0 : (d.y >= d.z ? 1 : 2)] += 1e-3;
    return foot_of(q, dvec3(0), 0.1 * glm::normalize(way));
}

/// Distance of a point from a quadric, to first order.
double off_of(const Quadric& q, const dvec3& r) {
    return q.at(r) / std::max(glm::length(q.slope(r)), 0.2);
}

/// Sum of squared distances, each at most 1, of the samples around voxel i that lie on the wrong side of a face. `off`:
/// signed distance from the face.
template <typename Off>
double wrong_sides(const Field& field, const ScaledScene& scene, const glm::ivec3& i, int m, const Off& off) {
    double wrong = 0;
    for (int k = 0; k < 27; ++k) {
        const glm::ivec3 o = glm::ivec3(k % 3, k / 3 % 3, k / 9) - 1, j = i + o;
        const bool inside = j == field.clamped(j) && scene.material(field.at(j)) == m;
        const double d = off(dvec3(o));
        wrong += std::pow(std::clamp(inside ? d : -d, 0.0, 1.0), 2);
    }
    return wrong;
}

/// The edge of a voxel at a crease. `error`: what its best quadric leaves. nullopt unless the planes leave less than
/// half of that, or than a fifth if two planes meet at a blunt angle and might be a narrow ridge. Planes also count if
/// they leave almost nothing. Only between samples of two values is the field's shape unknown.
std::optional<VoxelEdge> creased(const Field& field, const ScaledScene& scene, const glm::ivec3& i, int m,
                                 std::span<const Surfel> surfels, const Surfel& nearest, double error) {
    if (!scene.two_values) return std::nullopt;
    const CreasePlanes planes = crease_planes(surfels, nearest);
    if (planes.count < 2) return std::nullopt;
    double off = wrong_sides(field, scene, i, m, [&](const dvec3& r) { return planes.off(r); });
    // Surfels inside the planes come from rounding by the spline and are no error.
    for (const Surfel& s : surfels) {
        const double outside = std::max(planes.off(s.at), 0.0);
        off += surfel_weight(s.at - nearest.at, nearest.n, s.n) * outside * outside;
    }
    const bool blunt = glm::dot(planes.planes[0].n, planes.planes[1].n) > static_cast<double>(shader::CREASE_BLUNT);
    const bool better = off < (blunt ? static_cast<double>(shader::CREASE_BLUNT_LEFT) : kOwnShare) * error;
    if (!better && !(!blunt && off < static_cast<double>(shader::CREASE_ROUNDED_LEFT))) return std::nullopt;
    VoxelEdge edge;
    edge.has_edge = edge.has_normal = true;
    edge.upper = nearest.upper;
    edge.n = planes.planes[0].n;
    edge.D = planes.planes[0].D;
    edge.crease = planes.planes[1];
    edge.corner = corner_of(planes);
    return edge;
}

/// The nearest face along -n, found by surfels that the fit does not use. At the same end of the interval its normal
/// may be tilted (WALL_TILTED); at the other end it must be almost opposite (WALL_LEVEL).
struct FaceBehind {
    double away = std::numeric_limits<double>::infinity();
    dvec3 n{0};
    bool upper = false;
};
FaceBehind face_behind(const Field& field, const ScaledScene& scene, const std::vector<VoxelEdge>& surfels,
                       const glm::ivec3& i, int m, const dvec3& n, bool upper) {
    FaceBehind behind;
    for (int step = 1; step <= shader::WALL_STEPS; ++step) {
        const glm::ivec3 j = i + glm::ivec3(glm::roundEven(-static_cast<double>(step) * n));
        const auto s = surfel_of(field, scene, surfels, i, j, m);
        if (!s || s->border) continue;
        const double facing = -glm::dot(s->n, n), away = glm::dot(s->at, s->n) / facing;
        if (!(facing > (s->upper == upper ? kWallTilted : kWallLevel))) continue;
        if (away > 0 && away < behind.away) behind = {away, s->n, s->upper};
    }
    return behind;
}

/// H of a face with normal n, with the part of H n across n moved towards `turn` by `share`. That part is how much the
/// slope turns per voxel along n; on the face itself it has an effect of third order only.
dmat3 turned(const dmat3& h, const dvec3& n, const dvec3& turn, double share) {
    dvec3 change = share * (turn - h * n);
    change -= glm::dot(change, n) * n;
    return h + glm::outerProduct(n, change) + glm::outerProduct(change, n);
}

/// The larger of the two curvatures, if H n is small; outwards is positive.
double largest_bend(const dmat3& h) {
    const double norm = norm_of(h), sum = h[0][0] + h[1][1] + h[2][2];
    return 0.5 * (sum + std::sqrt(std::max(2 * norm * norm - sum * sum, 0.0)));
}

/// The turn of the field's slope, per voxel, between a face at distance d along n and voxel i with the gradient g.
dvec3 turn_of(const dvec3& g, double d) {
    const double length = glm::length(g);
    return length > 0 ? -g / length * d / (d * d + kTurnFrom) : dvec3(0);
}

/// Whether samples next to a voxel belong to materials below m, and above it.
struct Crossed {
    bool down = false, up = false;
};
Crossed crossed_beside(const Field& field, const ScaledScene& scene, const glm::ivec3& i, int m) {
    Crossed crossed;
    for (int k = 0; k < 27; ++k) {
        const int other = scene.material(field.at(i + glm::ivec3(k % 3, k / 3 % 3, k / 9) - 1));
        crossed.down = crossed.down || other < m;
        crossed.up = crossed.up || other > m;
    }
    return crossed;
}

/// Makes the face on the voxel's side of a layer the first one.
VoxelEdge near_face_first(VoxelEdge edge) {
    if (!(edge.D2 < 0)) return edge;
    edge.n = -edge.n;
    std::swap(edge.D, edge.D2);
    edge.bending = -edge.bending;
    edge.upper = !edge.upper;
    return edge;
}

/// Weight of the field's direction at a voxel, [0, 1]: from the slope there over the mean slope on the way to the face,
/// `way` / |d|. `way`: difference of the field's values at both.
double steep_of(double slope, double way, double d) {
    const double mean_slope = way / std::max(std::abs(d), 1e-6);
    const double times = slope / std::max(mean_slope, 1e-6);
    return std::clamp((times - static_cast<double>(shader::STEEP_FROM)) / static_cast<double>(shader::STEEP_OVER), 0.0,
                      1.0);
}

}  // namespace

std::optional<Surfel> surfel_of(const Field& field, const ScaledScene& scene, const std::vector<VoxelEdge>& surfels,
                                const glm::ivec3& i, const glm::ivec3& j, int m) {
    if (j != field.clamped(j)) return std::nullopt;
    const VoxelEdge& edge = surfels[field.offset(j)];
    if (!edge.has_edge) return std::nullopt;
    const int own = scene.material(field.at(j));
    // A surfel of the material below or above also bounds m, if it lies on their common iso-value. A surfel on the
    // volume's border bounds only its own material.
    const bool below = own + 1 == m && edge.upper && !edge.border, above = own == m + 1 && !edge.upper && !edge.border;
    if (own != m && !below && !above) return std::nullopt;
    return Surfel{dvec3(j - i) + edge.D * edge.n, own == m ? edge.n : -edge.n, own == m ? edge.upper : above,
                  edge.border};
}

Foot foot_of(const Quadric& q, const dvec3& voxel_at, dvec3 at) {
    for (int step = 0; step < shader::FOOT_STEPS; ++step) {
        const double steep = glm::length(q.slope(at)), value = q.at(at);
        const dvec3 up = q.slope(at) / std::max(steep, 1e-6);
        const double bend = glm::dot(up, q.h * up);
        const double moved = -2 * value / (steep + std::sqrt(std::max(steep * steep - 2 * value * bend, 0.0)) + 1e-6);
        at += std::clamp(moved, -1.0, 1.0) * up;
        const dvec3 from = at - voxel_at;
        if (step + 2 < shader::FOOT_STEPS) at -= 0.7 * (from - glm::dot(from, up) * up);
    }
    const dvec3 slope = q.slope(at);
    return {at, slope, glm::length(slope) >= 0.3 && std::abs(q.at(at)) < 0.05 && glm::length(at) < kFitRadius};
}

VoxelEdge fit_face(const Field& field, const ScaledScene& scene, const std::vector<VoxelEdge>& surfels,
                   const glm::ivec3& i, int m) {
    const bool beside = scene.material(field.at(i)) != m;
    const auto around = [&](const glm::ivec3& center, const auto& take) {
        for (int k = 0; k < 125; ++k) {
            const glm::ivec3 j = center + glm::ivec3(k % 5, k / 5 % 5, k / 25) - 2;
            if (const auto s = surfel_of(field, scene, surfels, i, j, m)) take(*s);
        }
    };
    Surfel nearest;
    double distance = std::numeric_limits<double>::infinity();
    around(i, [&](const Surfel& s) {
        // A voxel outside the matter uses no surfels on the border or beyond the outermost samples.
        const dvec3 at = dvec3(i) + s.at;
        if (beside && (s.border || glm::any(glm::lessThan(at, dvec3(0))) ||
                       glm::any(glm::greaterThan(at, dvec3(field.dims - 1)))))
            return;
        // The border ends matter however the kernel is cut; a surface beside it is known only from its face, so it goes
        // first.
        const double rank = glm::length(s.at) + (s.border ? static_cast<double>(shader::BORDER_BEHIND) : 0);
        // Among equally near surfels take the first, whatever the rounding.
        if (!(glm::length(s.at) < kFaceSearch) || !(rank < distance - 1e-4)) return;
        distance = rank;
        nearest = s;
    });
    if (nearest.border) {
        // A plane; the face behind it is the opposite border.
        VoxelEdge edge;
        edge.n = nearest.n;
        edge.D = glm::dot(nearest.at, nearest.n);
        edge.D2 = glm::dot(glm::abs(nearest.n), dvec3(field.dims)) - edge.D;
        edge.has_edge = edge.has_normal = true;
        return edge;
    }
    const bool found = std::isfinite(distance);
    const Crossed crossed = crossed_beside(field, scene, i, m);
    if (!found) {
        if (!crossed.down && !crossed.up) return edge_with_normal_only(field, i);
        nearest.upper = beside ? scene.material(field.at(i)) > m : !crossed.down;
    }
    const dvec3 middle = nearest.at, n = nearest.n;
    const glm::ivec3 center = i + glm::ivec3(glm::roundEven(middle));
    Moments all, same;
    double mixed = 0;
    std::vector<Surfel> seen;
    around(center, [&](const Surfel& s) {
        if (!s.border) seen.push_back(s);
    });
    for (const Surfel& s : seen) {
        const dvec3 r = s.at - middle;
        const double w = surfel_weight(r, n, s.n);
        all.add(r, s.n, w);
        if (glm::dot(s.n, n) > 0) same.add(r, s.n, w);
        if (glm::dot(s.n, n) < 0) mixed += s.upper != nearest.upper ? w : -w;
    }
    const Quadric one = quadric_of(all), wall = quadric_of(same);
    const double iso = nearest.upper ? scene.upper(m) : scene.lower(std::max(m, 1));
    const auto expansion = field_quadric(field, i, iso, nearest.upper ? -1 : 1);
    const Quadric& own = expansion.first;
    const double slope_there = expansion.second;
    double of_one = 0, of_own = 0, of_same = 0, opposite = 0, sum = 0, sum2 = 0;
    for (const Surfel& s : seen) {
        const dvec3 r = s.at - middle;
        const double w = surfel_weight(r, n, s.n), facing = glm::dot(s.n, n), level = wall.at(r);
        of_one += w * std::pow(off_of(one, r), 2);
        of_own += w * std::pow(off_of(own, s.at), 2);
        if (facing > 0) of_same += w * level * level;
        if (facing <= 0 && facing >= -0.5) of_same += w;
        if (facing >= -0.5) continue;
        opposite += w;
        sum += w * level;
        sum2 += w * level * level;
    }
    // Both faces of a wall are levels of one quadric, which is fitted to the nearer face.
    const double level = sum / std::max(opposite, 1e-20);
    const double of_wall = of_same + std::max(sum2 - sum * level, 0.0);
    bool is_wall = opposite > 0 && level < -kThinnest && of_wall < kWallShare * of_one;
    const double wrong = wrong_sides(field, scene, i, m, [&](const dvec3& r) {
        const double to_wall = wall.at(r - middle);
        return is_wall ? std::max(to_wall, level - to_wall) : off_of(one, r - middle);
    });
    const double error = (is_wall ? of_wall : of_one) + wrong;
    const double own_wrong = wrong_sides(field, scene, i, m, [&](const dvec3& r) { return off_of(own, r); });
    const double own_error = of_own + own_wrong;
    // If no single quadric fits the surfels, the field's own may: at specks, at corners, and in matter thinner than a
    // voxel.
    const Foot fitted = foot_of(is_wall ? wall : one, -middle, dvec3(0)), from_voxel = own_foot_of(own);
    const bool is_own = !found || (error > kWell && own_error < (error > kBadly ? 1 : kOwnShare) * error) ||
                        (!fitted.real && from_voxel.real);
    is_wall = is_wall && !is_own;
    if (found) {
        if (const auto edge = creased(field, scene, i, m, seen, nearest, is_own ? own_error : error)) return *edge;
    }
    const Quadric& q = is_own ? own : (is_wall ? wall : one);
    const Foot& foot = is_own ? from_voxel : fitted;
    if (is_own && !foot.real) return edge_with_normal_only(field, i);
    VoxelEdge edge;
    edge.has_edge = edge.has_normal = true;
    edge.upper = nearest.upper;
    // If no opposite surfel is found, the other face is the interval's lower end.
    edge.mixed = mixed > 0 || (mixed == 0 && nearest.upper);
    const double steep = glm::length(foot.slope);
    edge.n = foot.real ? foot.slope / steep : n;
    edge.D = glm::dot((is_own ? dvec3(0) : middle) + (foot.real ? foot.at : dvec3(0)), edge.n);
    if (foot.real) edge.bending = q.h / steep;
    // For a voxel outside the matter the expansion can have a surface where the field has none.
    const double off = std::abs(sample(field, dvec3(i) + edge.D * edge.n) - iso);
    if (is_own && beside && !(off < static_cast<double>(shader::MADE_UP) * slope_there))
        return edge_with_normal_only(field, i);
    if (foot.real && is_wall) edge.D2 = std::max(-level / steep - edge.D, 0.0);
    if (is_wall) return edge;
    // In a thin layer the samples around lie on both sides of it, perhaps none in it. The fit may find only one face.
    const bool layer = beside && crossed.down && crossed.up;
    if (layer) {
        edge.D2 = (scene.upper(m) - scene.lower(m)) / slope_there - edge.D;
        edge.mixed = true;
    }
    // Of a thicker wall the fit finds only one face. Strong outward bending over the thickness means it is not a wall.
    if (!foot.real) return near_face_first(edge);
    const FaceBehind behind = face_behind(field, scene, surfels, i, m, edge.n, nearest.upper);
    const double thickness = edge.D + behind.away;
    // In a wall the slope turns from one face's normal to the other's. If the fit found no opposite side, it turns to
    // the field's slope at the voxel, unless that slope is small: then its direction changes fast.
    const dvec3 g = (nearest.upper ? 1.0 : -1.0) * field_gradient(field, i);
    if (!is_own) edge.steep = steep_of(glm::length(g), std::abs(field.at(i) - iso), edge.D);
    if (std::isfinite(behind.away) && largest_bend(edge.bending) * thickness < kWallBent) {
        edge.D2 = behind.away;
        edge.mixed = behind.upper != nearest.upper;
        edge.bending = turned(edge.bending, edge.n, behind.n / (-glm::dot(behind.n, edge.n) * thickness), 1);
    } else if (!is_own && opposite == 0) {
        const double share = std::clamp(2 * glm::length(own.g) - 1, 0.0, 1.0);
        edge.bending = turned(edge.bending, edge.n, turn_of(g, beside ? edge.D : std::max(edge.D, 0.0)), share);
    }
    return near_face_first(edge);
}

}  // namespace edgesplat::reference
