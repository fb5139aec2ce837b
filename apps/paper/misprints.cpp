#include "apps/paper/misprints.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace edgesplat {
namespace {

double at(const Cubic& c, double x) {
    return ((c[0] * x + c[1]) * x + c[2]) * x + c[3];
}

double slope_at(const Cubic& c, double x) {
    return (3 * c[0] * x + 2 * c[1]) * x + c[2];
}

// Samples are denser near t1 and t2, where a p that is not monotone turns first.
bool rises_everywhere(const PaperProfile& q) {
    constexpr int kSamples = 400;
    const auto crowded = [](double u) { return u * u * (2 - u); };
    double before = 0;
    for (int piece = 0; piece < 3; ++piece) {
        for (int i = 1; i <= kSamples; ++i) {
            const double u = static_cast<double>(i) / kSamples;
            const double x = piece == 0   ? q.t1 * (1 - crowded(1 - u))
                             : piece == 1 ? q.t1 + (q.t2 - q.t1) * u
                                          : q.t2 + (1 - q.t2) * crowded(u);
            const double p = paper_profile(x, q);
            if (p < before - 1e-14) return false;
            before = p;
        }
    }
    return true;
}

}  // namespace

Boundary boundary_of(const Cubic& cubic, double start, double end) {
    return {at(cubic, start), slope_at(cubic, start), at(cubic, end), slope_at(cubic, end)};
}

Cubic interval1(const PaperProfile& q) {
    const double t2 = q.t1 * q.t1;
    return {(q.t1 - 2 * q.m1) / (t2 * q.t1), (3 * q.m1 - 2 * q.t1) / t2, 1, 0};
}

Cubic interval1_printed(const PaperProfile& q) {
    Cubic cubic = interval1(q);
    std::swap(cubic[2], cubic[3]);
    return cubic;
}

Boundary interval2_printed(const PaperProfile& q) {
    const double w = std::numbers::pi / (q.t2 - q.t1), h = (q.m2 - q.m1) / 2;
    const auto p = [&](double x) { return q.m1 + h * (std::cos(-w * (x - q.t1)) + 1); };
    const auto slope = [&](double x) { return -h * w * std::sin(w * (x - q.t1)); };
    return {p(q.t1), slope(q.t1), p(q.t2), slope(q.t2)};
}

SolvedCubic interval3_solved(const PaperProfile& q) {
    const double t = q.t2;
    double rows[4][5] = {{t * t * t, t * t, t, 1, q.m2}, {3 * t * t, 2 * t, 1, 0, 0}, {1, 1, 1, 1, 1}, {3, 2, 1, 0, 1}};
    SolvedCubic solved;
    solved.determinant = 1;
    for (int column = 0; column < 4; ++column) {
        int pivot = column;
        for (int r = column + 1; r < 4; ++r)
            if (std::abs(rows[r][column]) > std::abs(rows[pivot][column])) pivot = r;
        if (pivot != column) {
            std::swap(rows[pivot], rows[column]);
            solved.determinant = -solved.determinant;
        }
        solved.determinant *= rows[column][column];
        for (int r = 0; r < 4; ++r) {
            if (r == column) continue;
            const double factor = rows[r][column] / rows[column][column];
            for (int c = column; c < 5; ++c)
                rows[r][c] -= factor * rows[column][c];
        }
    }
    for (std::size_t i = 0; i < 4; ++i)
        solved.cubic[i] = rows[i][4] / rows[i][i];
    return solved;
}

Boundary required(const PaperProfile& q, int interval) {
    if (interval == 1) return {0, 1, q.m1, 0};
    if (interval == 2) return {q.m1, 0, q.m2, 0};
    return {q.m2, 0, 1, 1};
}

Boundary corrected(const PaperProfile& q, int interval) {
    const double ends[] = {0, q.t1, q.t2, 1};
    const double start = ends[interval - 1], end = ends[interval];
    // Slightly inside, so that each interval is evaluated by its own formula.
    const double in = 1e-13;
    return {paper_profile(start + in, q), paper_profile_slope(start + in, q), paper_profile(end - in, q),
            paper_profile_slope(end - in, q)};
}

MonotoneScan scan_monotone(int steps) {
    MonotoneScan scan;
    for (int a = 1; a < steps; ++a) {
        for (int b = a + 1; b < steps; ++b) {
            for (int c = 1; c < steps; ++c) {
                for (int d = 1; d < steps; ++d) {
                    const PaperProfile q{1.0 * a / steps, 1.0 * b / steps, 1.0 * c / steps, 1.0 * d / steps};
                    // In integers: rounding must not decide at the border.
                    const bool rule = 3 * c >= a && c < d && 3 * d <= 2 * steps + b;
                    const bool rises = c != d && rises_everywhere(q);
                    ++scan.profiles;
                    scan.monotone += rises ? 1 : 0;
                    scan.disagreements += rises == rule ? 0 : 1;
                }
            }
        }
    }
    return scan;
}

std::vector<SlopeRow> map_slopes(const PaperProfile& q) {
    PaperProfile smooth = q;
    smooth.curve = PaperCurve::Smooth;
    std::vector<SlopeRow> rows;
    for (int power = 2; power <= 10; power += 2) {
        const double h = std::pow(10.0, -power);
        rows.push_back({h, (q.t1 - paper_map(q.m1 - h, q)) / h, (paper_map(q.m2 + h, q) - q.t2) / h,
                        (q.t1 - paper_map(q.m1 - h, smooth)) / h});
    }
    return rows;
}

}  // namespace edgesplat
