#include "apps/paper/footprint_tiles.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <string>
#include <vector>

#include "engine/image/gnuplot.h"
#include "footprints/footprint_integral.h"
#include "footprints/kernel.h"
#include "footprints/plane_face.h"

namespace edgesplat {
namespace {

constexpr double kHalf = 1.8;  // voxels a tile shows to either side
constexpr int kTexels = 80;    // from tile to tile
constexpr double kPitch = 4;   // voxels from tile to tile

using Footprint = std::function<double(const Ray&, double distance)>;

struct Row {
    const char* title;
    double cosine;
    Footprint value;
};

// Columns 0 to 3 are voxels -1 to 2. A voxel's normal points across the edge: to the left for the voxels on the right.
Ray ray_of(int column, double x, double y, double cosine) {
    return ray_through(column < 2 ? x : -x, y, cosine);
}

double distance_of(int column, double edge) {
    const int voxel = column - 1;
    return column < 2 ? edge - voxel : voxel - edge;
}

double largest_difference(double edge, double cosine, const Footprint& a, const Footprint& b) {
    double most = 0;
    for (int column = 0; column < 4; ++column) {
        const double distance = distance_of(column, edge);
        for (int j = 0; j <= 20; ++j) {
            for (int i = 0; i <= 144; ++i) {
                const Ray ray = ray_of(column, kHalf * (i / 72.0 - 1), kHalf * j / 20.0, cosine);
                most = std::max(most, std::abs(a(ray, distance) - b(ray, distance)));
            }
        }
    }
    return most / kernel_footprint(0);
}

}  // namespace

FootprintTiles draw_footprint_tiles(const std::filesystem::path& target) {
    FootprintTiles result;
    const auto plain = [](const Ray& ray, double) { return kernel_footprint(ray.rho2); };
    const auto short_cut = [](const Ray& ray, double d) { return warp2d_footprint(ray, PaperEdge{d, {}}); };
    const auto paper = [](const Ray& ray, double d) { return exact_footprint(ray, PaperEdge{d, {}}); };
    const auto ours = [](const Ray& ray, double d) {
        return FacePath(plane_face(ray, d), plane_cut(d)).footprint(32).integral;
    };
    const double tilted = std::cos(result.degrees * std::numbers::pi / 180);
    const std::vector<Row> rows = {{"no warp", 0, plain},
                                   {"paper,\\nedge-on", 0, short_cut},
                                   {"ours,\\nedge-on", 0, ours},
                                   {"paper's\\nshort cut,\\n45 deg", tilted, short_cut},
                                   {"paper's curve,\\nexact,\\n45 deg", tilted, paper},
                                   {"ours,\\n45 deg", tilted, ours}};

    // One grid of texels over all tiles, rows from the bottom; NaN between tiles.
    const auto last = static_cast<int>(rows.size()) - 1;
    const auto cell = [&](int column, int down, double x, double y) {
        if (std::abs(x) > kHalf || std::abs(y) > kHalf) return std::string("NaN");
        const Row& row = rows[static_cast<std::size_t>(down)];
        const double value = row.value(ray_of(column, x, y, row.cosine), distance_of(column, result.edge));
        return fmt::format("{:.4g}", value / kernel_footprint(0));
    };
    std::string script = "set terminal pngcairo size 620,760 enhanced font ',11'\n$tiles << EOD\n";
    for (int j = 0; j < kTexels * (last + 1); ++j) {
        for (int i = 0; i < kTexels * 4; ++i) {
            const double x = kPitch * ((i % kTexels + 0.5) / kTexels - 0.5);
            const double y = kPitch * ((j % kTexels + 0.5) / kTexels - 0.5);
            script += fmt::format("{:.4g} {:.4g} {}\n", kPitch * (i / kTexels) + x, kPitch * (j / kTexels - last) + y,
                                  cell(i / kTexels, last - j / kTexels, x, y));
        }
    }
    std::string ticks;
    for (int r = 0; r <= last; ++r)
        ticks += fmt::format("{}\"{}\" {}", r == 0 ? "" : ", ", rows[static_cast<std::size_t>(r)].title, -kPitch * r);
    script += fmt::format(
        "EOD\nset title 'Figure 7: footprints of splats 0 to 3, the edge at {}'\n"
        "set xtics ('0' 0, '1' {}, '2' {}, '3' {}) scale 0\nset ytics ({}) scale 0\n"
        "set xlabel 'splat (a tile: {} x {} voxels, the edge normal along x)'\n"
        "set cblabel 'footprint / peak of the plain one'\nset palette cubehelix start 0.5 cycles -1 saturation 1\n"
        "set xrange [-2:14]\nset yrange [{}:2]\nset size ratio -1\nplot $tiles with image notitle\n",
        result.edge, kPitch, 2 * kPitch, 3 * kPitch, ticks, 2 * kHalf, 2 * kHalf, -kPitch * last - 2);
    draw_script(script, target);

    result.short_cut_error = largest_difference(result.edge, tilted, short_cut, paper);
    result.no_warp_error = largest_difference(result.edge, tilted, plain, paper);
    result.edge_on_difference = largest_difference(result.edge, 0, short_cut, paper);
    return result;
}

}  // namespace edgesplat
