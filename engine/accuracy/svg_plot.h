// Plots with logarithmic axes, as SVG that stands in a page; drawn by the program gnuplot.
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace edgesplat::accuracy {

/// Points of one kind: one entry of the legend.
struct PlotSeries {
    std::string title;
    std::string style;  ///< as gnuplot writes it after `with points`
    struct Point {
        double x = 0, y = 0;  ///< > 0; others are not drawn
        std::string label;    ///< beside the point; empty: none
    };
    std::vector<Point> points;
};

struct LogPlot {
    std::string x_title, y_title;
    std::vector<PlotSeries> series;               ///< later ones lie on top
    std::vector<std::pair<double, double>> line;  ///< drawn as steps: what is reached at that cost
};

/// The <svg> element. Throws Error where gnuplot is missing or fails.
std::string log_plot_svg(const LogPlot& plot);

/// The same as a file of its own. Empty where there is nothing to draw.
std::string log_plot_file(const LogPlot& plot);

/// What a gnuplot script draws, as the text of an SVG file. The script sets neither terminal nor output.
std::string svg_file(const std::string& script);

/// Text in single quotes, as gnuplot reads it.
std::string gnuplot_text(const std::string& text);

/// Text in which &, <, > and quotes are safe.
std::string escaped(const std::string& text);

}  // namespace edgesplat::accuracy
