// Computes the misprints in the formulas of Huang, Crawfis, Stredney 1998.
//
// docs/paper.md states which parts of the print are known; nothing else is assumed.
#pragma once

#include <array>
#include <vector>

#include "footprints/paper_warp.h"

namespace edgesplat {

/// Value and slope at the start and at the end of an interval.
struct Boundary {
    double start = 0, start_slope = 0, end = 0, end_slope = 0;
};

/// a x^3 + b x^2 + c x + d.
using Cubic = std::array<double, 4>;
Boundary boundary_of(const Cubic& cubic, double start, double end);

/// Interval 1, a and b as in design (3): with (c, d) = (1, 0), and swapped as printed.
Cubic interval1(const PaperProfile& profile);
Cubic interval1_printed(const PaperProfile& profile);

/// Interval 2 as printed, cos(-pi ...) + 1 instead of 1 - cos(pi ...).
Boundary interval2_printed(const PaperProfile& profile);

/// The cubic that meets p(t2) = m2, p'(t2) = 0, p(1) = 1, p'(1) = 1, from the four linear equations by elimination,
/// and their determinant, (1 - t2)^4.
struct SolvedCubic {
    Cubic cubic{};
    double determinant = 0;
};
SolvedCubic interval3_solved(const PaperProfile& profile);

/// required: the conditions of an interval (1, 2 or 3; interval 2: slope 0 at both ends). corrected: the values and
/// slopes of p of footprints/ there; values to rounding, slopes by the derivative's own formula.
Boundary required(const PaperProfile& profile, int interval);
Boundary corrected(const PaperProfile& profile, int interval);

/// Tests the rule `p is monotone iff t1/3 <= m1 < m2 <= (2 + t2)/3`: parameters on a grid, p sampled densely.
struct MonotoneScan {
    int profiles = 0, monotone = 0;
    int disagreements = 0;  ///< profiles for which samples and rule disagree
};
MonotoneScan scan_monotone(int steps);

/// Difference quotients of map from m1 downwards and from m2 upwards, over 10^-2, 10^-4, ... 10^-10.
struct SlopeRow {
    double step = 0, below_m1 = 0, above_m2 = 0;
    double smooth = 0;  ///< of the smooth variant, below m1
};
std::vector<SlopeRow> map_slopes(const PaperProfile& profile);

}  // namespace edgesplat
