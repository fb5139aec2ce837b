#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "engine/volume/analytic_internal.h"

namespace edgesplat::analytic {

namespace {

constexpr int kSide = 40;

/// Axes of a rotated body, so that none is aligned with the grid.
glm::dmat3 turned(double about_x, double about_y, double about_z) {
    const auto about = [](int axis, double angle) {
        glm::dmat3 m(1);
        const int a = (axis + 1) % 3, b = (axis + 2) % 3;
        m[a][a] = m[b][b] = std::cos(angle);
        m[a][b] = std::sin(angle);
        m[b][a] = -std::sin(angle);
        return m;
    };
    return about(2, about_z) * about(1, about_y) * about(0, about_x);
}

/// Transforms a distance function from a body's frame to the grid's.
DistanceFunction placed(const glm::dvec3& center, const glm::dmat3& axes, DistanceFunction own) {
    return [center, axes, own = std::move(own)](const glm::dvec3& x) {
        const Distance d = own(glm::transpose(axes) * (x - center));
        return Distance{d.value, axes * d.gradient};
    };
}

/// Union of disjoint bodies.
DistanceFunction nearest_of(std::vector<DistanceFunction> parts) {
    return [parts = std::move(parts)](const glm::dvec3& x) {
        Distance nearest{INFINITY, glm::dvec3(0)};
        for (const DistanceFunction& part : parts)
            if (const Distance d = part(x); d.value < nearest.value) nearest = d;
        return nearest;
    };
}

/// The foot of the perpendicular is p_i r_i^2 / (t + r_i^2), where sum (r_i p_i / (t + r_i^2))^2 = 1. Newton's method
/// starts where one term alone is 1. It increases monotonically to the root, because the sum is convex and decreasing.
Distance ellipsoid_distance(const glm::dvec3& x, const glm::dvec3& radii) {
    // On the planes of the shortest axes the sum may be undefined at the root; a small offset avoids this.
    const glm::dvec3 p = glm::max(glm::abs(x), glm::dvec3(1e-9));
    const glm::dvec3 squares = radii * radii;
    const glm::dvec3 starts = radii * p - squares;
    double t = std::max({starts.x, starts.y, starts.z});
    for (int i = 0; i < 100; ++i) {
        const glm::dvec3 q = radii * p / (t + squares);
        const double excess = glm::dot(q, q) - 1, slope = -2 * glm::dot(q * q, 1.0 / (t + squares));
        const double next = t - excess / slope;
        if (!(next > t)) break;
        t = next;
    }
    const glm::dvec3 foot = p * squares / (t + squares);
    const glm::dvec3 normal = glm::normalize(foot / squares);
    const glm::dvec3 sign(x.x < 0 ? -1 : 1, x.y < 0 ? -1 : 1, x.z < 0 ? -1 : 1);
    return {t * glm::length(p / (t + squares)), sign * normal};
}

/// Two overlapping balls: if the nearest surface point of one lies in the other, the nearest point is on their crease.
Distance two_balls(const glm::dvec3& x, const glm::dvec3& a, double ra, const glm::dvec3& b, double rb) {
    const Distance to_a = ball_distance(x - a, ra), to_b = ball_distance(x - b, rb);
    if (to_a.value >= 0 && to_b.value >= 0) return to_a.value < to_b.value ? to_a : to_b;
    const double apart = glm::length(b - a), along = (apart * apart + ra * ra - rb * rb) / (2 * apart);
    const glm::dvec3 axis = (b - a) / apart, center = a + along * axis;
    const double radius = std::sqrt(ra * ra - along * along);
    Distance deepest{0, glm::dvec3(0)};
    const auto consider = [&](const Distance& d) {
        if (d.value < deepest.value) deepest = d;
    };
    // Inside a ball, -d leads to its surface; the point counts only if it is outside the other ball.
    if (to_a.value < 0 && glm::length(x - to_a.value * to_a.gradient - b) >= rb) consider(to_a);
    if (to_b.value < 0 && glm::length(x - to_b.value * to_b.gradient - a) >= ra) consider(to_b);
    if (deepest.value < 0) return deepest;
    const glm::dvec3 p = x - center;
    const double z = glm::dot(p, axis);
    const glm::dvec3 across = p - z * axis;
    const double r = glm::length(across);
    const glm::dvec3 to_crease = r > 0 ? across * (radius / r) - p : radius * glm::dvec3(axis.y, -axis.x, 0) - p;
    const double d = glm::length(to_crease);
    return {-d, d > 0 ? to_crease / d : axis};
}

/// Centre line of the tube, along x, and its derivatives.
struct Winding {
    glm::dvec3 at, slope, bend;
};
Winding winding(double u) {
    constexpr double kTurn = 2 * kPi / 30, kTurn2 = 2 * kPi / 44, kWide = 6, kHigh = 4.5;
    const double a = kTurn * (u - 3), b = kTurn2 * (u - 11);
    return {{u, 19.3 + kWide * std::sin(a), 19.8 + kHigh * std::cos(b)},
            {1, kWide * kTurn * std::cos(a), -kHigh * kTurn2 * std::sin(b)},
            {0, -kWide * kTurn * kTurn * std::sin(a), -kHigh * kTurn2 * kTurn2 * std::cos(b)}};
}

/// Distance to the centre line and its gradient. Only points of the line whose x differs by at most the distance to the
/// point at x can be nearest. Every local minimum among samples of that range is refined.
Distance from_winding(const glm::dvec3& x) {
    constexpr int kPoints = 24;
    const double reach = glm::length(x - winding(x.x).at) + 1e-3, width = 2 * reach / (kPoints - 1);
    const auto squared = [&](double u) {
        const glm::dvec3 away = x - winding(u).at;
        return glm::dot(away, away);
    };
    std::array<double, kPoints> far{};
    for (int i = 0; i < kPoints; ++i)
        far[static_cast<std::size_t>(i)] = squared(x.x - reach + i * width);
    double best = x.x, least = squared(best);
    for (int i = 1; i + 1 < kPoints; ++i) {
        const auto at = static_cast<std::size_t>(i);
        if (far[at] > far[at - 1] || far[at] > far[at + 1]) continue;
        double low = x.x - reach + (i - 1) * width, high = low + 2 * width, u = low + width;
        for (int k = 0; k < 60 && high - low > 1e-13 * (1 + std::abs(u)); ++k) {
            const Winding w = winding(u);
            const double slope = -glm::dot(x - w.at, w.slope);
            const double bend = glm::dot(w.slope, w.slope) - glm::dot(x - w.at, w.bend);
            (slope < 0 ? low : high) = u;
            const double next = bend > 0 ? u - slope / bend : low;
            if (next == u) break;
            u = next > low && next < high ? next : 0.5 * (low + high);
        }
        if (const double d = squared(u); d < least) {
            least = d;
            best = u;
        }
    }
    const glm::dvec3 away = x - winding(best).at;
    const double d = std::sqrt(least);
    return {d, d > 0 ? away / d : glm::dvec3(0, 0, 1)};
}

/// (|f| - c) / g with g = |grad f| on the surface: a first-order distance.
Distance gyroid_distance(const glm::dvec3& p, double wave_number, double c) {
    const double k = wave_number;
    const glm::dvec3 s = glm::sin(k * p), o = glm::cos(k * p);
    const double f = s.x * o.y + s.y * o.z + s.z * o.x;
    const glm::dvec3 slope = k * glm::dvec3(o.x * o.y - s.z * s.x, o.y * o.z - s.x * s.y, o.z * o.x - s.y * s.z);
    const double xy = -o.x * s.y, xz = -o.z * s.x, yz = -o.y * s.z;
    const glm::dmat3 hessian =
        k * k *
        glm::dmat3(-s.x * o.y - s.z * o.x, xy, xz, xy, -s.x * o.y - s.y * o.z, yz, xz, yz, -s.y * o.z - s.z * o.x);
    // The second term keeps g above 0 at the extrema of f and is 0 on the surface.
    const double off = f * f - c * c;
    const double g = std::sqrt(glm::dot(slope, slope) + k * k * off * off);
    const glm::dvec3 rate = (hessian * slope + 2 * k * k * off * f * slope) / g;
    const double t = std::abs(f) - c;
    return {t / g, (f < 0 ? -1.0 : 1.0) * slope / g - t / (g * g) * rate};
}

}  // namespace

AnalyticScene ellipsoid() {
    const auto own = [](const glm::dvec3& p) { return ellipsoid_distance(p, {15.5, 10.2, 6.4}); };
    return solid("ellipsoid", glm::ivec3(kSide), {}, placed({19.7, 19.4, 19.2}, turned(0.4, 0.5, 0.7), own));
}

AnalyticScene box(std::string name, double rounding) {
    const auto own = [rounding](const glm::dvec3& p) { return box_distance(p, {11.5, 9.2, 7.3}, rounding); };
    return solid(std::move(name), glm::ivec3(kSide), {}, placed({19.6, 19.3, 19.4}, turned(0.5, 0.3, 0.6), own));
}

AnalyticScene tilted_torus() {
    const auto own = [](const glm::dvec3& p) { return ring_distance(p, 11.6, 4.4); };
    return solid("tilted-torus", glm::ivec3(kSide), {}, placed({19.6, 19.3, 19.4}, turned(0.6, 0.4, 0.2), own));
}

AnalyticScene tube() {
    return solid("tube", glm::ivec3(kSide), {}, [](const glm::dvec3& x) {
        constexpr double kLumen = 5.2;
        const Distance d = from_winding(x);
        return Distance{kLumen - d.value, -d.gradient};
    });
}

AnalyticScene shell() {
    return solid("shell", glm::ivec3(kSide), {}, [](const glm::dvec3& x) {
        constexpr double kRadius = 14.3, kThickness = 1.8;
        const Distance d = ball_distance(x - glm::dvec3(19.6, 19.3, 19.4), kRadius);
        return Distance{std::abs(d.value) - kThickness / 2, (d.value < 0 ? -1.0 : 1.0) * d.gradient};
    });
}

AnalyticScene balls() {
    return solid("balls", glm::ivec3(kSide), {}, [](const glm::dvec3& x) {
        return two_balls(x, {14.2, 16.1, 17.3}, 9.3, {26.4, 23.9, 22.6}, 7.4);
    });
}

AnalyticScene gyroid() {
    return solid("gyroid", glm::ivec3(kSide), {}, [](const glm::dvec3& x) {
        const glm::dvec3 p = x - glm::dvec3(19.6, 19.3, 19.4);
        const Distance wall = gyroid_distance(turned(0.3, 0.2, 0.1) * p, 2 * kPi / 20, 0.6);
        const Distance ball = ball_distance(p, 16.5);
        return wall.value > ball.value ? Distance{wall.value, glm::transpose(turned(0.3, 0.2, 0.1)) * wall.gradient}
                                       : ball;
    });
}

AnalyticScene ball(std::string name, double radius, bool binary) {
    return solid(std::move(name), glm::ivec3(kSide), {.binary = binary},
                 [radius](const glm::dvec3& x) { return ball_distance(x - glm::dvec3(19.7, 19.4, 19.2), radius); });
}

AnalyticScene vessels() {
    constexpr std::array<double, 5> kRadii = {0.9, 1.15, 1.4, 1.65, 1.9};
    std::vector<DistanceFunction> rings;
    for (std::size_t i = 0; i < kRadii.size(); ++i) {
        const double n = static_cast<double>(i) - 2;
        rings.push_back(placed({19.6 + 0.2 * n, 19.3 - 0.3 * n, 19.5 + 6.4 * n}, turned(0.06 - 0.02 * n, 0.05 * n, 0),
                               [radius = kRadii[i]](const glm::dvec3& p) { return ring_distance(p, 12.2, radius); }));
    }
    // The whole tree is rotated away from the grid axes.
    const glm::dvec3 center(19.5);
    return solid(
        "vessels", glm::ivec3(kSide), {},
        placed(center, turned(0.25, 0.2, 0.1),
               [whole = nearest_of(std::move(rings)), center](const glm::dvec3& p) { return whole(p + center); }));
}

AnalyticScene specks() {
    constexpr int kCount = 60;
    constexpr double kSmallest = 0.8, kLargest = 1.7, kMargin = 4, kGap = 1.5;
    struct Speck {
        glm::dvec3 center;
        double radius;
    };
    std::vector<Speck> specks;
    std::uint64_t state = 20;
    const auto next = [&state] {
        // Knuth's MMIX generator, upper 32 bits.
        state = state * 6364136223846793005ULL + 1442695040888963407ULL;
        return static_cast<double>(state >> 32U) / 4294967296.0;
    };
    while (specks.size() < kCount) {
        glm::dvec3 center;
        for (int axis = 0; axis < 3; ++axis)
            center[axis] = kMargin + (kSide - 1 - 2 * kMargin) * next();
        const double radius = kSmallest + (kLargest - kSmallest) * static_cast<double>(specks.size()) / (kCount - 1);
        const bool free = std::all_of(specks.begin(), specks.end(), [&](const Speck& other) {
            return glm::length(other.center - center) > other.radius + radius + kGap;
        });
        if (free) specks.push_back({center, radius});
    }
    return solid("specks", glm::ivec3(kSide), {}, [specks = std::move(specks)](const glm::dvec3& x) {
        Distance nearest{INFINITY, glm::dvec3(0)};
        for (const Speck& speck : specks)
            if (const double d = glm::length(x - speck.center) - speck.radius; d < nearest.value)
                nearest = {d, x - speck.center};
        const double r = glm::length(nearest.gradient);
        nearest.gradient = r > 0 ? nearest.gradient / r : glm::dvec3(1, 0, 0);
        return nearest;
    });
}

}  // namespace edgesplat::analytic
