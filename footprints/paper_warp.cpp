#include "footprints/paper_warp.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <string>

#include "footprints/kernel.h"

namespace edgesplat {
namespace {

// Monotone rational quadratic (Gregory and Delbourgo 1982) from (x0, y0) to (x1, y1) with end slopes s0, s1 > 0.
struct Piece {
    double x0, x1, y0, y1, s0, s1;

    double at(double x) const {
        const double e = (y1 - y0) / (x1 - x0), u = (x - x0) / (x1 - x0), v = u * (1 - u);
        return y0 + (y1 - y0) * (e * u * u + s0 * v) / (e + (s0 + s1 - 2 * e) * v);
    }
};

// The smooth variant defines map itself: knots (m1, t1), (m2, t2), slope 1 at the ends and the chord's between the
// knots.
Piece smooth_piece(double x, const PaperProfile& q) {
    const double slope = (q.t2 - q.t1) / (q.m2 - q.m1);
    if (x < q.m1) return {0, q.m1, 0, q.t1, 1, slope};
    if (x < q.m2) return {q.m1, q.m2, q.t1, q.t2, slope, slope};
    return {q.m2, 1, q.t2, 1, slope, 1};
}

// The x in [0, 1] with p(x) = y, by Newton steps that fall back to bisection where they would leave the bracket: p' = 0
// at the knots, so plain Newton may jump anywhere there.
template <typename P, typename Slope>
double invert(double y, const P& p, const Slope& slope) {
    double low = 0, high = 1, x = y;
    for (int i = 0; i < 200 && high - low > 1e-15; ++i) {
        const double error = p(x) - y;
        if (error == 0) return x;
        (error > 0 ? high : low) = x;
        const double step = x - error / slope(x);
        const double next = step > low && step < high ? step : (low + high) / 2;  // also where slope is 0
        if (std::abs(next - x) < 1e-16) return next;
        x = next;
    }
    return x;
}

double cosine_profile(double x, const PaperProfile& q) {
    if (x < q.t1) {
        const double u = x / q.t1;
        return q.t1 * u * (1 - u) * (1 - u) + q.m1 * u * u * (3 - 2 * u);
    }
    if (x < q.t2) return q.m1 + (q.m2 - q.m1) / 2 * (1 - std::cos(std::numbers::pi * (x - q.t1) / (q.t2 - q.t1)));
    const double L = 1 - q.t2, u = (x - q.t2) / L, h = u * u * (3 - 2 * u);
    return q.m2 * (1 - h) + h + L * u * u * (u - 1);
}

double cosine_slope(double x, const PaperProfile& q) {
    if (x < q.t1) {
        const double u = x / q.t1;
        return (1 - u) * (1 - 3 * u) + 6 * q.m1 / q.t1 * u * (1 - u);
    }
    if (x < q.t2) {
        const double pi_over_width = std::numbers::pi / (q.t2 - q.t1);
        return (q.m2 - q.m1) / 2 * pi_over_width * std::sin(pi_over_width * (x - q.t1));
    }
    const double L = 1 - q.t2, u = (x - q.t2) / L;
    return 6 * (1 - q.m2) / L * u * (1 - u) + u * (3 * u - 2);
}

void require(bool holds, const char* name, double value, const std::string& range) {
    if (!holds) throw std::invalid_argument(fmt::format("paper profile: {} = {:.6g} must be {}", name, value, range));
}

}  // namespace

void validate(const PaperProfile& q) {
    require(q.t1 > 0 && q.t1 < 1, "t1", q.t1, "in (0, 1)");
    require(q.t2 > q.t1 && q.t2 < 1, "t2", q.t2, fmt::format("in (t1, 1) = ({:.6g}, 1)", q.t1));
    require(q.m1 >= q.t1 / 3, "m1", q.m1,
            fmt::format("at least t1/3 = {:.6g}, or the profile is not monotone", q.t1 / 3));
    require(q.m2 > q.m1, "m2", q.m2, fmt::format("above m1 = {:.6g}", q.m1));
    require(q.m2 <= (2 + q.t2) / 3, "m2", q.m2,
            fmt::format("at most (2 + t2)/3 = {:.6g}, or the profile is not monotone", (2 + q.t2) / 3));
}

double paper_profile(double x, const PaperProfile& q) {
    if (!(x > 0 && x < 1)) return x;
    if (q.curve == PaperCurve::Cosine) return cosine_profile(x, q);
    // Here map has the closed form and p is its inverse.
    return invert(
        x, [&](double y) { return smooth_piece(y, q).at(y); }, [](double) { return 0.0; });
}

double paper_profile_slope(double x, const PaperProfile& q) {
    if (!(x > 0 && x < 1)) return 1;
    if (q.curve == PaperCurve::Cosine) return cosine_slope(x, q);
    const double y = paper_profile(x, q), h = 1e-6;
    return 2 * h / (smooth_piece(y + h, q).at(y + h) - smooth_piece(y - h, q).at(y - h));
}

double paper_map(double x, const PaperProfile& q) {
    if (!(x > 0 && x < 1)) return x;
    if (q.curve == PaperCurve::Smooth) return smooth_piece(x, q).at(x);
    return invert(
        x, [&](double y) { return cosine_profile(y, q); }, [&](double y) { return cosine_slope(y, q); });
}

double paper_interval(const PaperEdge& edge) {
    return edge.distance < 1 ? 0 : 1;
}

PaperProfile paper_profile_for(const PaperEdge& edge) {
    const PaperShape& shape = edge.shape;
    PaperProfile q{0.5 - shape.inset, 0.5 + shape.inset, 0, 0, shape.curve};
    const double low = q.t1 / 3 + shape.rise, high = (2 + q.t2) / 3 - shape.rise;
    // Slightly inside the legal region, so that rounding does not put m1 below t1/3.
    const double position = std::clamp(edge.distance - paper_interval(edge), low + 1e-9, high - 1e-9);
    q.m1 = position - shape.rise;
    q.m2 = position + shape.rise;
    return q;
}

double warped_coordinate(double t, const PaperEdge& edge) {
    if (!(edge.distance < kKernelRadius)) return t;
    const double start = paper_interval(edge);
    return start + paper_map(t - start, paper_profile_for(edge));
}

}  // namespace edgesplat
