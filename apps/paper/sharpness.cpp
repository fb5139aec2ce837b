#include "apps/paper/sharpness.h"

#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>
#include <vector>

namespace edgesplat {
namespace {

constexpr int kReach = 24;      // pixels to either side of an edge
constexpr double kStep = 0.25;  // pixels

class Luminance {
  public:
    explicit Luminance(const Image& image) : width_(image.width), height_(image.height) {
        for (int y = 0; y < height_; ++y)
            for (int x = 0; x < width_; ++x)
                values_.push_back(0.2126 * static_cast<double>(image.at(x, y, 0)) +
                                  0.7152 * static_cast<double>(image.at(x, y, 1)) +
                                  0.0722 * static_cast<double>(image.at(x, y, 2)));
    }

    double at(int x, int y) const {
        x = std::clamp(x, 0, width_ - 1);
        y = std::clamp(y, 0, height_ - 1);
        return values_[static_cast<std::size_t>(y * width_ + x)];
    }

    double between(const glm::dvec2& p) const {
        const int x = static_cast<int>(std::floor(p.x)), y = static_cast<int>(std::floor(p.y));
        const double u = p.x - x, v = p.y - y;
        return (at(x, y) * (1 - u) + at(x + 1, y) * u) * (1 - v) + (at(x, y + 1) * (1 - u) + at(x + 1, y + 1) * u) * v;
    }

    glm::dvec2 gradient(int x, int y) const {
        return {(at(x + 1, y) - at(x - 1, y)) / 2, (at(x, y + 1) - at(x, y - 1)) / 2};
    }

  private:
    int width_, height_;
    std::vector<double> values_;
};

/// Luminance along n (unit, uphill) from p to the end of the edge: one value a step, p's first.
std::vector<double> followed(const Luminance& picture, const glm::dvec2& p, const glm::dvec2& n, double slope) {
    std::vector<double> values{picture.between(p)};
    const double sign = slope > 0 ? 1 : -1;
    for (int i = 1; i <= kReach / kStep; ++i) {
        const double next = picture.between(p + n * (i * kStep));
        if (sign * (next - values.back()) < 0.05 * std::abs(slope) * kStep) break;
        values.push_back(next);
    }
    return values;
}

/// From 10 to 90 % of a rising profile, pixels.
double width_of(const std::vector<double>& profile) {
    const double low = profile.front(), range = profile.back() - low;
    const auto crossing = [&](double share) {
        const double level = low + share * range;
        const auto above = std::lower_bound(profile.begin(), profile.end(), level);
        const auto i = std::max<std::ptrdiff_t>(above - profile.begin(), 1);
        const double a = profile[static_cast<std::size_t>(i - 1)], b = profile[static_cast<std::size_t>(i)];
        return static_cast<double>(i - 1) + (level - a) / (b - a);
    };
    return (crossing(0.9) - crossing(0.1)) * kStep;
}

double at_rank(std::vector<double> values, double share) {
    const auto rank = values.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
    std::nth_element(values.begin(), rank, values.end());
    return *rank;
}

}  // namespace

Sharpness sharpness(const Image& color) {
    const Luminance picture(color);
    Sharpness result;
    std::vector<double> slopes;
    for (int y = 0; y + 1 < color.height; ++y) {
        for (int x = 0; x + 1 < color.width; ++x) {
            const double dx = picture.at(x + 1, y) - picture.at(x, y), dy = picture.at(x, y + 1) - picture.at(x, y);
            result.gradient_energy += dx * dx + dy * dy;
            slopes.push_back(glm::length(picture.gradient(x, y)));
        }
    }
    const double steep = at_rank(slopes, 0.95);
    std::vector<double> widths;
    for (int y = 1; y + 1 < color.height; ++y) {
        for (int x = 1; x + 1 < color.width; ++x) {
            const glm::dvec2 g = picture.gradient(x, y);
            const double slope = glm::length(g);
            if (!(slope > 0 && slope >= steep)) continue;
            const glm::dvec2 n = g / slope, p(x, y);
            const auto neighbour = [&](double sign) {
                return glm::length(picture.gradient(x + static_cast<int>(std::lround(sign * n.x)),
                                                    y + static_cast<int>(std::lround(sign * n.y))));
            };
            if (slope < neighbour(1) || slope < neighbour(-1)) continue;
            std::vector<double> profile = followed(picture, p, -n, -slope);
            std::reverse(profile.begin(), profile.end());
            const std::vector<double> uphill = followed(picture, p, n, slope);
            profile.insert(profile.end(), uphill.begin() + 1, uphill.end());
            if (profile.size() > 2) widths.push_back(width_of(profile));
        }
    }
    result.edges = static_cast<int>(widths.size());
    result.edge_width = widths.empty() ? 0 : at_rank(widths, 0.5);
    return result;
}

}  // namespace edgesplat
