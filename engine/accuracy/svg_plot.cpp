#include "engine/accuracy/svg_plot.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/error.h"
#include "engine/image/gnuplot.h"

namespace edgesplat::accuracy {
namespace {

constexpr double kMost = std::numeric_limits<double>::max();

bool drawable(double x, double y) {
    return x > 0 && y > 0 && std::isfinite(x) && std::isfinite(y);
}

/// The plot command, preceded by the data as blocks. Empty if there is nothing to draw.
std::string script_of(const LogPlot& plot) {
    std::string blocks, commands;
    const auto add = [&](const std::string& command) { commands += (commands.empty() ? "" : ", ") + command; };
    std::string steps;
    for (const auto& [x, y] : plot.line)
        if (drawable(x, y)) steps += fmt::format("{:.6g} {:.6g}\n", x, y);
    if (!steps.empty()) {
        blocks += "$front << EOD\n" + steps + "EOD\n";
        add("$front using 1:2 with steps lw 1.5 lc rgb '#c8501e' notitle");
    }
    std::string names, numbers;  // labels on different sides of the points
    double x_low = kMost, x_high = 0, y_low = kMost, y_high = 0;
    for (std::size_t i = 0; i < plot.series.size(); ++i) {
        const PlotSeries& series = plot.series[i];
        std::string rows;
        for (const auto& p : series.points) {
            if (!drawable(p.x, p.y)) continue;
            rows += fmt::format("{:.6g} {:.6g}\n", p.x, p.y);
            x_low = std::min(x_low, p.x);
            x_high = std::max(x_high, p.x);
            y_low = std::min(y_low, p.y);
            y_high = std::max(y_high, p.y);
            if (p.label.empty()) continue;
            const bool number = p.label.find_first_not_of("0123456789") == std::string::npos;
            (number ? numbers : names) += fmt::format("{:.6g} {:.6g} \"{}\"\n", p.x, p.y, p.label);
        }
        if (rows.empty()) continue;
        blocks += fmt::format("$series{} << EOD\n{}EOD\n", i, rows);
        add(fmt::format("$series{} using 1:2 with points {} title {}", i, series.style, gnuplot_text(series.title)));
    }
    if (!names.empty()) {
        blocks += "$names << EOD\n" + names + "EOD\n";
        add("$names using 1:2:3 with labels left offset 0.8,0.6 noenhanced notitle");
    }
    if (!numbers.empty()) {
        blocks += "$numbers << EOD\n" + numbers + "EOD\n";
        add("$numbers using 1:2:3 with labels right offset -0.8,-0.6 noenhanced notitle");
    }
    if (commands.empty()) return {};
    return fmt::format("{}set xrange [{:.6g}:{:.6g}]\nset yrange [{:.6g}:{:.6g}]\nplot {}\n", blocks, x_low / 1.3,
                       x_high * 1.6, y_low / 1.5, y_high * 1.5, commands);
}

}  // namespace

std::string escaped(const std::string& text) {
    std::string out;
    for (const char c : text) {
        switch (c) {
            case '&':
                out += "&amp;";
                break;
            case '<':
                out += "&lt;";
                break;
            case '>':
                out += "&gt;";
                break;
            case '"':
                out += "&quot;";
                break;
            default:
                out += c;
        }
    }
    return out;
}

std::string gnuplot_text(const std::string& text) {
    // Inside single quotes only the quote itself is special.
    std::string out = "'";
    for (const char c : text)
        out += c == '\'' ? "''" : std::string(1, c);
    return out + "'";
}

std::string svg_file(const std::string& script) {
    return run_gnuplot("set terminal svg size 900,520 dynamic font 'system-ui,sans-serif,14' background 'white'\n" +
                       script);
}

std::string log_plot_file(const LogPlot& plot) {
    const std::string script = script_of(plot);
    if (script.empty()) return {};
    return svg_file(
        fmt::format("set logscale xy\nset bmargin 7\n"
                    "set grid lc rgb '#e3e7ec' lt 1 lw 1\nset border lc rgb '#5c6773'\nset format y '%g'\n"
                    "set key at screen 0.5,0.02 bottom center horizontal reverse Left\n"
                    "set xlabel {} noenhanced\nset ylabel {} noenhanced\n{}",
                    gnuplot_text(plot.x_title), gnuplot_text(plot.y_title), script));
}

std::string log_plot_svg(const LogPlot& plot) {
    const std::string text = log_plot_file(plot);
    if (text.empty()) return "<p>There is nothing to draw.</p>\n";
    // The text before the element belongs to a separate file only.
    const std::size_t begin = text.find("<svg");
    if (begin == std::string::npos) fail("gnuplot wrote no <svg> element");
    std::string element = "<svg class=\"plot\" role=\"img\"" + text.substr(begin + 4);
    // A page knows the namespaces. Without their addresses a reader sees that nothing is fetched.
    for (std::size_t at = element.find(" xmlns"); at < element.find('>'); at = element.find(" xmlns"))
        element.erase(at, element.find('"', element.find('"', at) + 1) + 1 - at);
    return element;
}

}  // namespace edgesplat::accuracy
