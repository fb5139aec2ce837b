#include "apps/paper/curve_sections.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "apps/paper/footprint_tiles.h"
#include "footprints/face.h"
#include "footprints/kernel.h"

namespace edgesplat {
namespace {

constexpr double kLow = -1.5, kHigh = 2.5;

/// The place where a falling function first goes below a level; NaN if nowhere.
double crossing(const std::function<double(double)>& value, double level) {
    constexpr int kSteps = 40000;
    double before = value(kLow);
    for (int i = 1; i <= kSteps; ++i) {
        const double x = kLow + (kHigh - kLow) * i / kSteps, now = value(x);
        if (before >= level && now < level) return x - (kHigh - kLow) / kSteps * (level - now) / (before - now);
        before = now;
    }
    return NAN;
}

std::string picture(const std::string& text, const std::filesystem::path& file) {
    return fmt::format("![{}](images/paper/{})\n", text, file.filename().string());
}

std::string profile_text(const CurveExample& e, const std::filesystem::path& file) {
    const PaperProfile& q = e.profile;
    return fmt::format(
        "## Figure 4: the profile p\n\n{}\nThe paper moves each point of the unit interval between two voxels. It "
        "writes the inverse of this "
        "movement: p maps the\nsampled position to the visible one. t1 = {}, t2 = {}, m1 = {}, m2 = {}.\n\n"
        "Measured: p(t1) = {:.6f}, p(t2) = {:.6f}, and the edge p(1/2) = {:.6f}. The middle interval is {:.2f} voxel "
        "wide and is\nsqueezed into {:.2f}. Its slope is {:.4f} in the middle and 0 at both ends; `paper-smooth` has "
        "{:.4f} there.\n",
        picture("The profile p between its knots, the paper's and a smooth variant", file), q.t1, q.t2, q.m1, q.m2,
        paper_profile(q.t1, q), paper_profile(q.t2, q), paper_profile(0.5, q), q.t2 - q.t1, q.m2 - q.m1,
        paper_profile_slope(0.5, q), paper_profile_slope(q.t1 + 1e-9, e.smooth()));
}

std::string map_text(const CurveExample& e, const std::filesystem::path& file) {
    const PaperProfile& q = e.profile;
    const PaperProfile smooth = e.smooth();
    const double at = e.edge(), h = 1e-6;
    const auto width = [](const auto& inverse) { return inverse(0.8) - inverse(0.2); };
    return fmt::format(
        "## Figure 6: map, the inverse of p\n\n{}\nA kernel is sampled at map(x) instead of x. Measured:\n\n"
        "| map | slope at the edge | voxels over which map goes from 0.2 to 0.8 | range |\n"
        "|---|--:|--:|---|\n"
        "| none | 1 | {:.4f} | |\n"
        "| paper (corrected) | {:.3f}, infinite at m1 and m2 | {:.4f} | [0, 1] |\n"
        "| paper-smooth | {:.3f} | {:.4f} | [0, 1] |\n"
        "| face | a step: the kernel ends there | nearer than {} voxel to the face all samples are at that depth | its "
        "own side |\n\n"
        "The two infinite slopes turn one edge into a double step: see \"Not a misprint\" below.\n",
        picture("map(x) of the paper, of its smooth variant and of a face", file), 0.6, 1 / paper_profile_slope(0.5, q),
        width([&](double w) { return paper_profile(w, q); }),
        (paper_map(at + h, smooth) - paper_map(at - h, smooth)) / (2 * h),
        width([&](double w) { return paper_profile(w, smooth); }), FACE_DEPTH);
}

/// Largest |sum of the kernels - 1| on the line; `sum` gives it for uniform data at x.
template <typename Sum>
double ripple(const Sum& sum) {
    const CurveExample uniform{.left = 1, .right = 1};
    double most = 0;
    for (int i = 0; i <= 4000; ++i)
        most = std::max(most, std::abs(sum(uniform, kLow + (kHigh - kLow) * i / 4000) - 1));
    return most;
}

std::string splat_text(const CurveExample& e, const std::filesystem::path& file, const std::filesystem::path& tiles) {
    const FootprintTiles t = draw_footprint_tiles(tiles);
    return fmt::format(
        "## Figure 7: splats 0 to 3\n\n{}\nThe voxels at -1, 0, 1, 2, weighted with their values ({} up to voxel 0, {} "
        "from voxel 1 on): secondary and primary on\nthe side of the larger value, primary and secondary on the other "
        "side.\n\nMeasured, largest deviation of the sum in uniform data from 1:\n\n"
        "| not warped | paper: all four share one map | cut at a face: each side ends where the other begins |\n"
        "|--:|--:|--:|\n| {:.1e} | {:.1e} | {:.1e} |\n\n{}\n"
        "The same four as footprints; top: the plain kernel. The paper's short cut warps the two-dimensional "
        "footprint. Edge-on (the edge's\nnormal perpendicular to the ray) it is exact: the largest difference is "
        "{:.1e} of the plain peak. At {:.0f} degrees between normal and ray\nits largest error is {:.0f} % of the "
        "peak; without any warp it is {:.0f} %. A tilted edge blurs in projection. Ours integrates the cut kernel\n"
        "along the ray at every angle. (Curve parameters here are the renderer's for an edge at {}: t1, t2 = 0.2, 0.8; "
        "m1, m2 = {:.2f}, {:.2f}.)\n",
        picture("Four weighted kernels, warped and not", file), e.left, e.right, ripple(reconstruction),
        ripple([&](const CurveExample& u, double x) { return reconstruction(u, paper_map(x, e.profile)); }),
        ripple(cut_reconstruction), picture("Table of footprints of the four splats", tiles), t.edge_on_difference,
        t.degrees, 100 * t.short_cut_error, 100 * t.no_warp_error, t.edge, t.edge - PaperShape{}.rise,
        t.edge + PaperShape{}.rise);
}

std::string reconstruction_text(const CurveExample& e, const std::filesystem::path& file) {
    const PaperProfile smooth = e.smooth();
    const auto row = [&](const char* name, const std::function<double(double)>& value) {
        const StepQuality q = step_quality(e, value);
        return fmt::format("| {} | {:.3f} | {:+.4f} | {:.4f} |\n", name, q.rise, q.location, q.rms);
    };
    return fmt::format(
        "## Figure 8: two-tone data reconstructed\n\n{}\nThe sum of the splats of Figure 7 on [-1.5, 2.5]. Measured "
        "(voxels; rms against the ideal step of height {}):\n\n| | rise, 10 to 90 % | location error | rms |\n"
        "|---|--:|--:|--:|\n{}{}{}{}",
        picture("Normal reconstruction against two warped ones and one that is cut", file), e.left - e.right,
        row("normal", [&](double x) { return reconstruction(e, x); }),
        row("paper (corrected)", [&](double x) { return reconstruction(e, paper_map(x, e.profile)); }),
        row("paper-smooth", [&](double x) { return reconstruction(e, paper_map(x, smooth)); }),
        row("face", [&](double x) { return cut_reconstruction(e, x); }));
}

}  // namespace

StepQuality step_quality(const CurveExample& e, const std::function<double(double)>& value) {
    const double step = e.left - e.right;
    StepQuality quality;
    quality.rise = crossing(value, e.right + 0.1 * step) - crossing(value, e.right + 0.9 * step);
    quality.location = crossing(value, e.right + 0.5 * step) - e.edge();
    constexpr int kSamples = 20000;
    for (int i = 0; i < kSamples; ++i) {
        const double x = kLow + (kHigh - kLow) * (i + 0.5) / kSamples;
        const double error = value(x) - (x < e.edge() ? e.left : e.right);
        quality.rms += error * error / kSamples;
    }
    quality.rms = std::sqrt(quality.rms);
    return quality;
}

std::vector<Section> curve_sections(const CurveExample& example, const std::filesystem::path& images) {
    std::vector<std::filesystem::path> files;
    for (const Plot& plot : paper_plots(example))
        files.push_back(draw(plot, images, PlotFormat::Svg));
    return {{"figure 4", profile_text(example, files[0])},
            {"figure 6", map_text(example, files[1])},
            {"figure 7", splat_text(example, files[2], images / "figure7_footprints.png")},
            {"figure 8", reconstruction_text(example, files[3])}};
}

}  // namespace edgesplat
