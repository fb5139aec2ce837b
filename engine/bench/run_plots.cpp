// Draws the plots of a measured suite, and writes its files.
#include <algorithm>
#include <array>

#include "engine/accuracy/json_text.h"
#include "engine/accuracy/report_files.h"
#include "engine/accuracy/svg_plot.h"
#include "engine/bench/run_output.h"
#include "engine/error.h"
#include "engine/image/image_file.h"

namespace edgesplat::bench {
namespace {

constexpr std::array<const char*, 6> kStyles{"pt 7 ps 0.9 lc rgb '#2060a8'",  "pt 5 ps 0.9 lc rgb '#c8501e'",
                                             "pt 9 ps 1.0 lc rgb '#3c8c3c'",  "pt 13 ps 1.0 lc rgb '#8040a0'",
                                             "pt 11 ps 1.0 lc rgb '#a08020'", "pt 6 ps 0.9 lc rgb '#505860'"};

/// One row per case: the median, and a bar from p10 to p90.
std::string ratio_plot(const BenchRun& run) {
    std::string rows;
    for (std::size_t i = 0; i < run.cases.size(); ++i) {
        const CaseResult& c = run.cases[i];
        rows +=
            fmt::format("{:.6g} {:.6g} {:.6g} {} \"{}\"\n", c.ratio.median, c.ratio.low, c.ratio.high, i + 1, c.name);
    }
    if (rows.empty()) return {};
    const std::string label = fmt::format("frame over ray caster, {} time", run.clock);
    return accuracy::svg_file(
        fmt::format("$rows << EOD\n{}EOD\nset logscale x\nset format x '%g'\nset grid lc rgb '#e3e7ec' lt 1 lw 1\n"
                    "set lmargin 42\nset yrange [{}.5:0.5]\nset xlabel {} noenhanced\nset ytics noenhanced\n"
                    "set arrow from 1, graph 0 to 1, graph 1 nohead lc rgb '#c8501e'\n"
                    "plot $rows using 1:4:2:3:ytic(5) with xerrorbars pt 7 ps 0.8 lc rgb '#2060a8' notitle\n",
                    rows, run.cases.size(), accuracy::gnuplot_text(label)));
}

template <typename X, typename Y>
std::string scaling_plot(const BenchRun& run, const std::string& x_title, const std::string& y_title, const X& x,
                         const Y& y) {
    accuracy::LogPlot plot{.x_title = x_title, .y_title = y_title};
    for (const CaseResult& c : run.cases) {
        if (c.series.empty()) continue;
        const std::string title = fmt::format("{} {} {}x{}", c.series, c.mode, c.size.x, c.size.y);
        auto found = std::find_if(plot.series.begin(), plot.series.end(),
                                  [&](const accuracy::PlotSeries& s) { return s.title == title; });
        if (found == plot.series.end())
            found = plot.series.insert(plot.series.end(), {title, kStyles.at(plot.series.size() % kStyles.size()), {}});
        found->points.push_back({x(c), y(c), {}});
    }
    return accuracy::log_plot_file(plot);
}

}  // namespace

std::vector<PlotFile> run_plots(const BenchRun& run) {
    std::vector<PlotFile> plots{
        {"ratio.svg", ratio_plot(run)},
        {"frame_scaling.svg", scaling_plot(
                                  run, "splats drawn", "frame, ms",
                                  [](const CaseResult& c) { return static_cast<double>(c.stats.splats_drawn); },
                                  [](const CaseResult& c) { return c.frame.median; })},
        {"setup_scaling.svg", scaling_plot(
                                  run, "voxels", "setup, ms", [](const CaseResult& c) { return c.voxels(); },
                                  [](const CaseResult& c) { return c.setup.median; })}};
    std::erase_if(plots, [](const PlotFile& plot) { return plot.text.empty(); });
    return plots;
}

void check_run_folder(const std::filesystem::path& folder) {
    accuracy::check_report_folder(folder);
}

std::string write_run(const BenchRun& run, const std::filesystem::path& folder) {
    std::vector<FileContent> files{{folder / "bench.json", json_text(run_json(run), 2) + "\n"},
                                   {folder / "bench.csv", run_csv(run)}};
    std::string note;
    try {
        for (PlotFile& plot : run_plots(run))
            files.push_back({folder / plot.name, std::move(plot.text)});
    } catch (const Error& error) {
        note = fmt::format("no plots: {}", error.what());
    }
    std::error_code ignored;
    std::filesystem::create_directories(folder, ignored);
    write_files(files);
    return note;
}

}  // namespace edgesplat::bench
