#include "engine/accuracy/svg_plot.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace edgesplat::accuracy {
namespace {

constexpr double kWidth = 900, kHeight = 520, kLeft = 78, kRight = 20, kTop = 16, kBottom = 58;
constexpr double kLetter = 7, kLineHeight = 14;  ///< about, of a label

/// A logarithmic axis that ends at 1, 2 or 5 times a power of ten.
class LogAxis {
  public:
    LogAxis(double low, double high, double from, double to) : from_(from), to_(to) {
        low_ = std::log10(ticked(low, false));
        high_ = std::log10(ticked(high, true));
        if (!(high_ > low_)) high_ = low_ + 1;
    }
    double at(double value) const { return from_ + (std::log10(value) - low_) / (high_ - low_) * (to_ - from_); }

    /// Values of the grid lines; all of them are labelled if they are few, else the powers of ten.
    std::vector<double> ticks() const {
        std::vector<double> list;
        const bool fine = high_ - low_ < 2.5;
        for (int power = static_cast<int>(std::floor(low_)); power <= static_cast<int>(std::ceil(high_)); ++power)
            for (const double m : {1.0, 2.0, 5.0}) {
                if (m > 1 && !fine) continue;
                const double value = m * std::pow(10, power);
                if (std::log10(value) > low_ - 1e-9 && std::log10(value) < high_ + 1e-9) list.push_back(value);
            }
        return list;
    }

  private:
    /// The nearest 1, 2 or 5 times a power of ten that is not inside.
    static double ticked(double value, bool up) {
        const double base = std::pow(10, std::floor(std::log10(value)));
        double best = up ? 10 * base : base;
        for (const double m : {1.0, 2.0, 5.0}) {
            if (up && m * base >= value) return m * base;
            if (!up && m * base <= value) best = m * base;
        }
        return best;
    }
    double from_, to_, low_ = 0, high_ = 1;
};

struct Box {
    double x0, y0, x1, y1;
    bool meets(const Box& o) const { return x0 < o.x1 && o.x0 < x1 && y0 < o.y1 && o.y0 < y1; }
};

/// Finds each label a place that no earlier one takes.
class Labels {
  public:
    explicit Labels(std::vector<Box> taken) : taken_(std::move(taken)) {}

    std::string place(double x, double y, const std::string& text) {
        const double width = kLetter * static_cast<double>(text.size());
        for (const auto& [dx, dy] : kOffsets) {
            const double left = dx > 0 ? x + dx : (dx < 0 ? x + dx - width : x - width / 2);
            const Box box{left, y + dy - kLineHeight + 3, left + width, y + dy + 3};
            const bool outside =
                box.x0 < kLeft || box.x1 > kWidth - kRight || box.y0 < kTop || box.y1 > kHeight - kBottom;
            if (outside || std::any_of(taken_.begin(), taken_.end(), [&](const Box& b) { return b.meets(box); }))
                continue;
            taken_.push_back(box);
            return fmt::format("<text class=\"label\" x=\"{:.1f}\" y=\"{:.1f}\">{}</text>\n", left, y + dy,
                               escaped(text));
        }
        return {};
    }

  private:
    static constexpr std::array<std::pair<double, double>, 10> kOffsets{
        {{9, 4}, {9, -8}, {9, 16}, {-9, 4}, {-9, -8}, {-9, 16}, {0, -12}, {0, 22}, {14, 28}, {-14, 28}}};
    std::vector<Box> taken_;
};

bool drawable(double x, double y) {
    return x > 0 && y > 0 && std::isfinite(x) && std::isfinite(y);
}

std::string grid(const LogAxis& x, const LogAxis& y) {
    std::string svg;
    for (const double v : x.ticks())
        svg += fmt::format(
            "<line class=\"grid\" x1=\"{0:.1f}\" x2=\"{0:.1f}\" y1=\"{1}\" y2=\"{2}\"/>"
            "<text class=\"tick\" text-anchor=\"middle\" x=\"{0:.1f}\" y=\"{3}\">{4:g}</text>\n",
            x.at(v), kTop, kHeight - kBottom, kHeight - kBottom + 18, v);
    for (const double v : y.ticks())
        svg += fmt::format(
            "<line class=\"grid\" x1=\"{1}\" x2=\"{2}\" y1=\"{0:.1f}\" y2=\"{0:.1f}\"/>"
            "<text class=\"tick\" text-anchor=\"end\" x=\"{3}\" y=\"{4:.1f}\">{5:g}</text>\n",
            y.at(v), kLeft, kWidth - kRight, kLeft - 8, y.at(v) + 4, v);
    return svg;
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

std::string log_plot_svg(const LogPlot& plot) {
    constexpr double kMost = std::numeric_limits<double>::max();
    double x_low = kMost, x_high = 0, y_low = kMost, y_high = 0;
    for (const PlotPoint& p : plot.points) {
        if (!drawable(p.x, p.y)) continue;
        x_low = std::min(x_low, p.x);
        x_high = std::max(x_high, p.x);
        y_low = std::min(y_low, p.y);
        y_high = std::max(y_high, p.y);
    }
    if (!(x_high > 0)) return "<p>Nothing to draw.</p>\n";
    const LogAxis x(x_low * 0.97, x_high * 1.03, kLeft, kWidth - kRight);
    const LogAxis y(y_low * 0.95, y_high * 1.05, kHeight - kBottom, kTop);

    std::string svg =
        fmt::format("<svg class=\"plot\" viewBox=\"0 0 {} {}\" role=\"img\" aria-label=\"{} against {}\">\n", kWidth,
                    kHeight, escaped(plot.y_title), escaped(plot.x_title));
    svg += grid(x, y);
    svg += fmt::format("<rect class=\"axis\" x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\"/>\n", kLeft, kTop,
                       kWidth - kLeft - kRight, kHeight - kTop - kBottom);
    svg += fmt::format("<text class=\"title\" text-anchor=\"middle\" x=\"{}\" y=\"{}\">{}</text>\n",
                       (kLeft + kWidth - kRight) / 2, kHeight - 14, escaped(plot.x_title));
    svg += fmt::format(
        "<text class=\"title\" text-anchor=\"middle\" transform=\"translate(18 {}) rotate(-90)\">{}</text>\n",
        (kTop + kHeight - kBottom) / 2, escaped(plot.y_title));

    std::string path;
    for (const auto& [px, py] : plot.line) {
        if (!drawable(px, py)) continue;
        path += path.empty() ? fmt::format("M{:.1f} {:.1f}", x.at(px), y.at(py))
                             : fmt::format(" H{:.1f} V{:.1f}", x.at(px), y.at(py));
    }
    if (!path.empty()) svg += fmt::format("<path class=\"front\" d=\"{}\"/>\n", path);

    std::vector<Box> taken;
    for (const PlotPoint& p : plot.points) {
        if (!drawable(p.x, p.y)) continue;
        const double px = x.at(p.x), py = y.at(p.y);
        svg += fmt::format("<circle class=\"{}\" cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"5\"><title>{}</title></circle>\n",
                           p.kind, px, py, escaped(p.tooltip));
        taken.push_back({px - 5, py - 5, px + 5, py + 5});
    }
    Labels labels(std::move(taken));
    for (const PlotPoint& p : plot.points)
        if (!p.label.empty() && drawable(p.x, p.y)) svg += labels.place(x.at(p.x), y.at(p.y), p.label);
    return svg + "</svg>\n";
}

}  // namespace edgesplat::accuracy
