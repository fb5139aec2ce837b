// Plots with logarithmic axes, as SVG that stands in a page.
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace edgesplat::accuracy {

struct PlotPoint {
    double x = 0, y = 0;  ///< > 0; others are not drawn
    std::string kind;     ///< CSS class
    std::string label;    ///< beside the point; empty: none
    std::string tooltip;  ///< seen when the pointer rests on it
};

struct LogPlot {
    std::string x_title, y_title;
    std::vector<PlotPoint> points;                ///< later ones lie on top
    std::vector<std::pair<double, double>> line;  ///< drawn as steps: what is reached at that cost
};

/// Labels keep clear of each other and of the frame where there is room. Styles come from the page (classes plot, grid,
/// tick, axis, front, label and the points' own).
std::string log_plot_svg(const LogPlot& plot);

/// Text in which &, <, > and quotes are safe.
std::string escaped(const std::string& text);

}  // namespace edgesplat::accuracy
