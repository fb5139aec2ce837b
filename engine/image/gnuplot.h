// Draws plots of functions with gnuplot.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace edgesplat {

struct Curve {
    std::string title;  ///< empty: no legend entry
    std::function<double(double)> y;
    std::string style = "lw 2";  ///< gnuplot style after `with lines`
};

struct Plot {
    std::string name;  ///< stem of the file name
    std::string title, x_label, y_label;
    double low = 0, high = 1;  ///< range of x
    std::vector<Curve> curves;
    std::string extra;  ///< further gnuplot commands
};

enum class PlotFormat { Png, Svg };

/// Writes `folder`/name.png or .svg atomically and returns its path; creates the folder if needed. Throws Error if
/// gnuplot is missing or fails, or if the folder cannot be written.
std::filesystem::path draw(const Plot& plot, const std::filesystem::path& folder, PlotFormat format);

/// Runs a gnuplot script and returns the bytes of the picture. The script sets the terminal but no output; no file is
/// written. Throws Error if gnuplot is missing or fails.
std::string run_gnuplot(const std::string& script);

/// Runs a gnuplot script and writes the picture to `target` atomically, like `draw`.
void draw_script(const std::string& script, const std::filesystem::path& target);

}  // namespace edgesplat
