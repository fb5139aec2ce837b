#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "apps/paper/curve_sections.h"
#include "apps/paper/misprints.h"

namespace edgesplat {
namespace {

constexpr int kScanSteps = 20;

std::string row(const std::string& name, const Boundary& b) {
    const auto number = [](double v) { return fmt::format("{:.6g}", std::abs(v) < 1e-9 ? 0.0 : v); };
    return fmt::format("| {} | {} | {} | {} | {} |\n", name, number(b.start), number(b.start_slope), number(b.end),
                       number(b.end_slope));
}

std::string table(const char* from, const char* to, const std::string& rows) {
    return fmt::format("| | p({0}) | p'({0}) | p({1}) | p'({1}) |\n|---|--:|--:|--:|--:|\n{2}", from, to, rows);
}

std::string interval1_text(const PaperProfile& q) {
    return fmt::format(
        "### Interval 1: c and d are swapped\n\np(x) = a x^3 + b x^2 + c x + d on [0, t1]. In print, as recorded, a "
        "and b are right and (c, d) = (0, 1). It must be\n(1, 0), because p(0) = d and p'(0) = c. As printed, p is too "
        "large by 1 - x everywhere.\n\n{}\nCorrect, u = x/t1: p = t1 u (1-u)^2 + m1 (3u^2 - 2u^3).\n",
        table("0", "t1",
              row("required", required(q, 1)) + row("printed", boundary_of(interval1_printed(q), 0, q.t1)) +
                  row("c and d exchanged", boundary_of(interval1(q), 0, q.t1)) + row("ours", corrected(q, 1))));
}

std::string interval2_text(const PaperProfile& q) {
    return fmt::format(
        "### Interval 2: reversed\n\nPrinted, as recorded: p(x) = m1 + (m2 - m1)/2 (cos(-pi (x-t1)/(t2-t1)) + 1). It "
        "falls from m2 to m1 but must\nrise from m1 to m2. It meets neither neighbour, and together with them it has "
        "no inverse.\n\n{}\nCorrect: p = m1 + (m2 - m1)/2 (1 - cos(pi (x-t1)/(t2-t1))).\n",
        table("t1", "t2",
              row("required", required(q, 2)) + row("printed", interval2_printed(q)) + row("ours", corrected(q, 2))));
}

std::string interval3_text(const PaperProfile& q) {
    const SolvedCubic solved = interval3_solved(q);
    double most = 0;
    for (int i = 0; i <= 1000; ++i) {
        const double x = q.t2 + (1 - q.t2) * i / 1000;
        const Cubic& c = solved.cubic;
        most = std::max(most, std::abs(((c[0] * x + c[1]) * x + c[2]) * x + c[3] - paper_profile(x, q)));
    }
    return fmt::format(
        "### Interval 3: the closed form does not meet its own boundary conditions\n\nThe printed coefficients are not "
        "on record and are not guessed here. Their values for t2 = 0.8, m2 = 0.4 are on record:\np(0.8) = -84.3 and "
        "p(1) = -100; the conditions require 0.4 and 1.\n\nProof that no other closed form can be right: the four "
        "conditions are linear in the cubic's coefficients. Their\ndeterminant is {:.6g} = (1 - t2)^4 (checked: "
        "{:.6g}), never 0, so they have exactly one solution. Elimination gives\n{:.6f} x^3 {:+.6f} x^2 {:+.6f} x "
        "{:+.6f}. The form below differs from it by at most {:.1e} on [t2, 1]. A form that\ndiffers more violates a "
        "condition.\n\n{}\n"
        "Correct, L = 1-t2, u = (x-t2)/L: p = m2 (1 - 3u^2 + 2u^3) + (3u^2 - 2u^3) + L (u^3 - u^2).\n",
        solved.determinant, std::pow(1 - q.t2, 4), solved.cubic[0], solved.cubic[1], solved.cubic[2], solved.cubic[3],
        most,
        table("t2", "1",
              row("required", required(q, 3)) + row("solved by elimination", boundary_of(solved.cubic, q.t2, 1)) +
                  row("ours", corrected(q, 3))));
}

std::string monotone_text() {
    const MonotoneScan scan = scan_monotone(kScanSteps);
    return fmt::format(
        "### Which parameters are legal\n\nThe corrected p is monotone, and so has an inverse, iff t1/3 <= m1 < m2 <= "
        "(2 + t2)/3. With r = m1/t1,\np'(u) = (1-u) (1 + (6r-3) u) on interval 1; this is not negative up to u = 1 iff "
        "r >= 1/3. Interval 3 is its mirror image.\nScan: t1 < t2, m1, m2 in steps of 1/{}, {} profiles, p sampled at "
        "1200 places each. {} rise everywhere. They are those\nof the rule ({} disagreements). Other parameters are "
        "refused with a message that says which and why.\n",
        kScanSteps, scan.profiles, scan.monotone, scan.disagreements);
}

std::string slope_text(const PaperProfile& q) {
    std::string rows;
    for (const SlopeRow& r : map_slopes(q))
        rows += fmt::format("| {:.0e} | {:.4g} | {:.4g} | {:.4g} |\n", r.step, r.below_m1, r.above_m2, r.smooth);
    return fmt::format(
        "### Not a misprint, but not C1 either\n\nThe conditions themselves require p'(t1) = p'(t2) = 0, so map = p^-1 "
        "has an infinite slope at m1 and m2, inside every\nwarped kernel. Difference quotients of map over a step h: "
        "they grow tenfold for a hundredth of h, so map - t ~ sqrt(h):\n\n"
        "| h | (t1 - map(m1 - h)) / h | (map(m2 + h) - t2) / h | `paper-smooth`, at m1 |\n|--:|--:|--:|--:|\n{}\n"
        "`paper-smooth` puts a monotone rational quadratic through the same knots, with finite slopes.\n",
        rows);
}

}  // namespace

Section misprint_section(const PaperProfile& q) {
    return {
        "misprints",
        fmt::format(
            "## Misprints\n\nThe print itself was not at hand. The formulas come from notes on a text conversion of "
            "it, so the conversion may have\ncaused some of the damage. Each formula is given only as far "
            "as it is on record. The program that writes this page computes\nevery number, with t1 = {}, "
            "t2 = {}, m1 = {}, m2 = {}. Slopes of \"ours\" come from the derivative that the inversion "
            "uses.\n\n",
            q.t1, q.t2, q.m1, q.m2) +
            interval1_text(q) + "\n" + interval2_text(q) + "\n" + interval3_text(q) + "\n" + monotone_text() + "\n" +
            slope_text(q)};
}

}  // namespace edgesplat
