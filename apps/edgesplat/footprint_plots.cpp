#include "apps/edgesplat/footprint_plots.h"

#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cmath>
#include <fstream>
#include <functional>
#include <string>
#include <system_error>

#include "engine/error.h"
#include "footprints/kernel.h"
#include "footprints/paper_warp.h"

namespace {

using namespace edgesplat;
namespace fs = std::filesystem;

struct Curve {
    std::string title;
    std::function<double(double)> y;
    std::string style = "lw 2";
};

struct Figure {
    std::string file, title, x_label, y_label;
    double low, high;
    std::vector<Curve> curves;
    std::string extra;  // gnuplot commands
};

// The example that all figures show: two-tone data, 1 up to voxel 0 and 0.25 from voxel 1 on, an edge at 0.375.
constexpr double kEdge = 0.375;
constexpr double kLeft = 1, kRight = 0.25;

double value_at_voxel(int i) {
    return i <= 0 ? kLeft : kRight;
}

double reconstruct(double x) {
    double sum = 0;
    for (int i = -5; i <= 6; ++i)
        sum += value_at_voxel(i) * kernel_plane_integral((x - i) * (x - i));
    return sum;
}

std::vector<Figure> figures(const EdgeBand& band) {
    const PaperProfile profile = paper_profile_for({kEdge, {}});
    PaperProfile smooth = profile;
    smooth.curve = PaperCurve::Smooth;
    const auto edge = [band](double x) { return kEdge + edge_warp(x - kEdge, band); };

    Figure profile_figure = {"figure4_profile.png", "Figure 4: warp profile p", "x", "p(x)", 0, 1, {},
                             "set key left top"};
    profile_figure.curves = {{"paper (corrected)", [=](double x) { return paper_profile(x, profile); }},
                             {"paper-smooth", [=](double x) { return paper_profile(x, smooth); }, "lw 2 dt 2"},
                             {"no warp", [](double x) { return x; }, "lw 1 lc rgb 'gray'"}};
    profile_figure.extra +=
        fmt::format("\nset xtics (0, 't1' {}, 't2' {}, 1)\nset ytics (0, 'm1' {}, 'm2' {}, 1)\nset grid", profile.t1,
                    profile.t2, profile.m1, profile.m2);

    Figure map_figure = {
        "figure6_map.png",           "Figure 6: map, where a point is sampled", "x", "map(x)", -0.5, 1.5, {},
        "set key left top\nset grid"};
    map_figure.curves = {{"paper (corrected)", [=](double x) { return paper_map(x, profile); }},
                         {"paper-smooth", [=](double x) { return paper_map(x, smooth); }, "lw 2 dt 2"},
                         {fmt::format("edge, a = {}, k = {}", band.half_width, band.strength), edge},
                         {"no warp", [](double x) { return x; }, "lw 1 lc rgb 'gray'"}};

    Figure splats = {"figure7_splats.png",
                     "Figure 7: the four warped splats around an edge at 0.375",
                     "x",
                     "weight * value",
                     -2.6,
                     3.6,
                     {},
                     "set key right top\nset grid"};
    const char* names[] = {"0: secondary, larger value", "1: primary, larger value", "2: primary, lower value",
                           "3: secondary, lower value"};
    for (int i = -1; i <= 2; ++i) {
        const auto splat = [=](double x) { return value_at_voxel(i) * kernel_plane_integral((x - i) * (x - i)); };
        const auto warped = [=](double x) { return splat(paper_map(x, profile)); };
        splats.curves.push_back({names[i + 1], warped, fmt::format("lw 2 lc {}", i + 2)});
        splats.curves.push_back({"", splat, fmt::format("lw 1 dt 3 lc {}", i + 2)});
    }

    Figure two_tone = {"figure8_reconstruction.png",
                       "Figure 8: two-tone data reconstructed",
                       "x",
                       "value",
                       -1.5,
                       2.5,
                       {},
                       "set key right top\nset grid\nset yrange [0.15:1.1]"};
    two_tone.curves = {{"normal", reconstruct},
                       {"paper (corrected)", [=](double x) { return reconstruct(paper_map(x, profile)); }},
                       {"paper-smooth", [=](double x) { return reconstruct(paper_map(x, smooth)); }, "lw 2 dt 2"},
                       {"edge", [=](double x) { return reconstruct(edge(x)); }}};
    two_tone.extra += fmt::format("\nset arrow from {0},graph 0 to {0},graph 1 nohead dt 3", kEdge);
    return {profile_figure, map_figure, splats, two_tone};
}

std::string quoted(const fs::path& path) {
    std::string text = "'";
    for (const char c : path.string())
        text += c == '\'' ? "''" : std::string(1, c);
    return text + "'";
}

std::string script_of(const Figure& figure, const fs::path& target) {
    std::string script = fmt::format(
        "set terminal pngcairo size 900,600 enhanced font ',12'\nset output {}\nset title '{}'\nset xlabel '{}'\nset "
        "ylabel "
        "'{}'\nset xrange [{}:{}]\n{}\n",
        quoted(target), figure.title, figure.x_label, figure.y_label, figure.low, figure.high, figure.extra);
    constexpr int kSteps = 1200;
    std::string plot = "plot ";
    for (std::size_t c = 0; c < figure.curves.size(); ++c) {
        const Curve& curve = figure.curves[c];
        script += fmt::format("$curve{} << EOD\n", c);
        for (int i = 0; i <= kSteps; ++i) {
            const double x = figure.low + (figure.high - figure.low) * i / kSteps;
            script += fmt::format("{:.8g} {:.8g}\n", x, curve.y(x));
        }
        script += "EOD\n";
        plot += fmt::format("{}$curve{} with lines {} {}", c == 0 ? "" : ", ", c, curve.style,
                            curve.title.empty() ? "notitle" : "title '" + curve.title + "'");
    }
    return script + plot + "\nset output\n";
}

void run_gnuplot(const std::string& script, const fs::path& target) {
    const fs::path script_file = fs::path(target).replace_extension(".gp");
    {
        std::ofstream out(script_file);
        out << script;
        if (!out.flush()) fail("{}: cannot be written", script_file.string());
    }
    // No shell in between: nothing in a path can be mistaken for syntax.
    std::string program = "gnuplot", argument = script_file.string();
    char* arguments[] = {program.data(), argument.data(), nullptr};
    pid_t child = 0;
    const int problem = ::posix_spawnp(&child, program.c_str(), nullptr, nullptr, arguments, environ);
    int status = 0;
    if (problem == 0) ::waitpid(child, &status, 0);
    std::error_code ignored;
    fs::remove(script_file, ignored);
    if (problem == ENOENT || (WIFEXITED(status) && WEXITSTATUS(status) == 127))
        fail("gnuplot is not installed (Debian: gnuplot-nox); it draws the plots");
    if (problem != 0) fail("gnuplot cannot be started: {}", std::generic_category().message(problem));
    if (status != 0 || !fs::exists(target, ignored))
        fail("gnuplot failed to write {} (status {})", target.string(), status);
}

}  // namespace

std::vector<fs::path> plot_paper_figures(const fs::path& folder, const EdgeBand& band) {
    std::error_code error;
    fs::create_directories(folder, error);
    if (error) fail("{}: {}", folder.string(), error.message());
    if (::access(folder.c_str(), W_OK) != 0) fail("{}: cannot be written", folder.string());

    std::vector<fs::path> written;
    for (const Figure& figure : figures(band)) {
        const fs::path target = folder / figure.file;
        const fs::path temporary = folder / fmt::format(".{}.{}", ::getpid(), figure.file);
        try {
            run_gnuplot(script_of(figure, temporary), temporary);
            fs::rename(temporary, target);
        } catch (...) {
            fs::remove(temporary, error);
            throw;
        }
        written.push_back(target);
    }
    return written;
}
