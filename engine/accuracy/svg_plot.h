// Draws plots with logarithmic axes as SVG, by the program gnuplot.
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace edgesplat::accuracy {

/// Points of one kind, with one entry in the legend.
struct PlotSeries {
    std::string title;
    std::string style;  ///< gnuplot's text after `with points`
    struct Point {
        double x = 0, y = 0;  ///< > 0; other points are not drawn
        std::string label;    ///< beside the point; empty: none
    };
    std::vector<Point> points;
};

struct LogPlot {
    std::string x_title, y_title;
    std::vector<PlotSeries> series;               ///< later series lie on top
    std::vector<std::pair<double, double>> line;  ///< drawn as steps: error reached at a cost
};

/// The <svg> element for a page. Throws Error if gnuplot is missing or fails.
std::string log_plot_svg(const LogPlot& plot);

/// The same as a separate file. Empty if there is nothing to draw.
std::string log_plot_file(const LogPlot& plot);

/// The SVG file that a gnuplot script draws. The script sets neither terminal nor output.
std::string svg_file(const std::string& script);

/// The text in single quotes, escaped for gnuplot.
std::string gnuplot_text(const std::string& text);

/// The text with &, <, > and quotes escaped for HTML.
std::string escaped(const std::string& text);

}  // namespace edgesplat::accuracy
