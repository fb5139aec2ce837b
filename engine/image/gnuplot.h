// Plots of functions, drawn by the program gnuplot.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace edgesplat {

struct Curve {
    std::string title;  ///< empty: not in the legend
    std::function<double(double)> y;
    std::string style = "lw 2";  ///< as gnuplot writes it after `with lines`
};

struct Plot {
    std::string name;  ///< stem of its file
    std::string title, x_label, y_label;
    double low = 0, high = 1;  ///< of x
    std::vector<Curve> curves;
    std::string extra;  ///< further gnuplot commands
};

enum class PlotFormat { Png, Svg };

/// Writes `folder`/name.png or .svg and returns its path; a file appears only when it is complete. The folder is made
/// if it is missing. Throws Error if gnuplot is missing or fails, or the folder cannot be written.
std::filesystem::path draw(const Plot& plot, const std::filesystem::path& folder, PlotFormat format);

/// What gnuplot writes for a script, which sets its terminal but no output: a picture file. No file is made. Throws
/// Error if gnuplot is missing or fails.
std::string run_gnuplot(const std::string& script);

/// The same as a file, as `draw` makes it.
void draw_script(const std::string& script, const std::filesystem::path& target);

}  // namespace edgesplat
