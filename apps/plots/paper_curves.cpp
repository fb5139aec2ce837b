#include "apps/plots/paper_curves.h"

#include <fmt/format.h>

#include <algorithm>

#include "footprints/face.h"
#include "footprints/kernel.h"

namespace edgesplat {
namespace {

Curve no_warp() {
    return {"no warp", [](double x) { return x; }, "lw 1 lc rgb 'gray'"};
}

Plot profile_plot(const CurveExample& e) {
    const PaperProfile q = e.profile, smooth = e.smooth();
    Plot plot{"figure4_profile",
              "Figure 4: the warp profile p",
              "x (voxels)",
              "p(x) (voxels)",
              0,
              1,
              {},
              fmt::format("set key left top\nset grid\nset xtics ('0' 0, 't1 = {0}' {0}, 't2 = {1}' {1}, '1' 1)\n"
                          "set ytics ('0' 0, 'm1 = {2}' {2}, 'm2 = {3}' {3}, '1' 1)",
                          q.t1, q.t2, q.m1, q.m2)};
    plot.curves = {{"paper (corrected)", [=](double x) { return paper_profile(x, q); }},
                   {"paper-smooth", [=](double x) { return paper_profile(x, smooth); }, "lw 2 dt 2"},
                   no_warp()};
    return plot;
}

Plot map_plot(const CurveExample& e) {
    const PaperProfile q = e.profile, smooth = e.smooth();
    Plot plot{"figure6_map",
              "Figure 6: map, where a point is sampled",
              "x (voxels)",
              "map(x) (voxels)",
              -0.5,
              1.5,
              {},
              "set key left top\nset grid"};
    plot.curves = {{"paper (corrected)", [=](double x) { return paper_map(x, q); }},
                   {"paper-smooth", [=](double x) { return paper_map(x, smooth); }, "lw 2 dt 2"},
                   {"face, from its left", [=](double x) { return std::min(x, e.edge() - FACE_DEPTH); }},
                   no_warp()};
    return plot;
}

Plot splat_plot(const CurveExample& e) {
    Plot plot{"figure7_splats",
              fmt::format("Figure 7: the four splats around an edge at {}, warped (dotted: not warped)", e.edge()),
              "x (voxels)",
              "kernel * value (1/voxel)",
              -2.6,
              3.6,
              {},
              "set key right top\nset grid"};
    const char* names[] = {"0: secondary, larger value", "1: primary, larger value", "2: primary, lower value",
                           "3: secondary, lower value"};
    for (int i = -1; i <= 2; ++i) {
        const auto splat = [=](double x) { return weighted_kernel(e, i, x); };
        const auto warped = [=](double x) { return weighted_kernel(e, i, paper_map(x, e.profile)); };
        plot.curves.push_back({names[i + 1], warped, fmt::format("lw 2 lc {}", i + 2)});
        plot.curves.push_back({"", splat, fmt::format("lw 1.5 dt 3 lc {}", i + 2)});
    }
    return plot;
}

Plot two_tone_plot(const CurveExample& e) {
    const PaperProfile q = e.profile, smooth = e.smooth();
    Plot plot{"figure8_reconstruction",
              fmt::format("Figure 8: two-tone data reconstructed, the edge at {}", e.edge()),
              "x (voxels)",
              "value",
              -1.5,
              2.5,
              {},
              fmt::format("set key right top\nset grid\nset yrange [{}:{}]\n"
                          "set arrow from {},graph 0 to {},graph 1 nohead dt 3",
                          e.right - 0.1, e.left + 0.1, e.edge(), e.edge())};
    plot.curves = {{"normal", [=](double x) { return reconstruction(e, x); }},
                   {"paper (corrected)", [=](double x) { return reconstruction(e, paper_map(x, q)); }},
                   {"paper-smooth", [=](double x) { return reconstruction(e, paper_map(x, smooth)); }, "lw 2 dt 2"},
                   {"face", [=](double x) { return cut_reconstruction(e, x); }}};
    return plot;
}

}  // namespace

PaperProfile CurveExample::smooth() const {
    PaperProfile q = profile;
    q.curve = PaperCurve::Smooth;
    return q;
}

double weighted_kernel(const CurveExample& example, int i, double x) {
    return (i <= 0 ? example.left : example.right) * kernel_plane_integral((x - i) * (x - i));
}

double reconstruction(const CurveExample& example, double x) {
    double sum = 0;
    for (int i = -5; i <= 6; ++i)
        sum += weighted_kernel(example, i, x);
    return sum;
}

double cut_reconstruction(const CurveExample& example, double x) {
    const bool left = x < example.edge();
    const double at = left ? std::min(x, example.edge() - FACE_DEPTH) : std::max(x, example.edge() + FACE_DEPTH);
    double sum = 0;
    for (int i = left ? -5 : 1; i <= (left ? 0 : 6); ++i)
        sum += weighted_kernel(example, i, at);
    return sum;
}

std::vector<Plot> paper_plots(const CurveExample& example) {
    return {profile_plot(example), map_plot(example), splat_plot(example), two_tone_plot(example)};
}

}  // namespace edgesplat
