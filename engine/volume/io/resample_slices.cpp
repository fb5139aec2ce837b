// Resamples slices at uneven heights to even ones: cubic interpolation of four slices whose slopes come from parabolas
// through three. Exact for quadratic functions.
#include <algorithm>
#include <array>
#include <cmath>

#include "engine/volume/io/readers.h"

namespace edgesplat::detail {
namespace {

/// Weights of up to four slices from `first` on.
struct Weights {
    std::size_t first = 0, count = 0;
    std::array<double, 4> of{};
};

/// Adds `factor` times the slope at slice `i`.
void add_slope(const std::vector<double>& heights, std::size_t i, double factor, Weights& out) {
    const std::size_t last = heights.size() - 1;
    if (last == 1) {
        const double gap = heights[1] - heights[0];
        out.of[0] -= factor / gap;
        out.of[1] += factor / gap;
        return;
    }
    // The parabola through the slice and its neighbours; at an end, through the outermost three.
    const std::size_t a = std::min(i == 0 ? 0 : i - 1, last - 2);
    const double x = heights[i];
    for (std::size_t j = a; j <= a + 2; ++j) {
        const double p = heights[j == a ? a + 1 : a], q = heights[j == a + 2 ? a + 1 : a + 2];
        out.of.at(j - out.first) += factor * (2 * x - p - q) / ((heights[j] - p) * (heights[j] - q));
    }
}

Weights weights_at(const std::vector<double>& heights, double height) {
    const auto above = std::upper_bound(heights.begin() + 1, heights.end() - 1, height);
    const auto i = static_cast<std::size_t>(above - heights.begin()) - 1;
    Weights out;
    out.count = std::min<std::size_t>(4, heights.size());
    out.first = std::min(i == 0 ? 0 : i - 1, heights.size() - out.count);
    const double gap = heights[i + 1] - heights[i], t = std::clamp((height - heights[i]) / gap, 0.0, 1.0);
    const double rest = 1 - t;
    out.of.at(i - out.first) += (1 + 2 * t) * rest * rest;
    out.of.at(i + 1 - out.first) += (1 + 2 * rest) * t * t;
    add_slope(heights, i, gap * t * rest * rest, out);
    add_slope(heights, i + 1, -gap * rest * t * t, out);
    return out;
}

}  // namespace

std::vector<float> resampled_slices(const std::vector<float>& slices, const std::vector<double>& heights,
                                    std::size_t count) {
    const std::size_t part = slices.size() / heights.size();
    std::vector<float> out(part * count);
    for (std::size_t k = 0; k < count; ++k) {
        const double share = static_cast<double>(k) / static_cast<double>(count - 1);
        const Weights weights = weights_at(heights, heights.back() * share);
        for (std::size_t v = 0; v < part; ++v) {
            double sum = 0;
            for (std::size_t j = 0; j < weights.count; ++j)
                sum += weights.of.at(j) * static_cast<double>(slices[(weights.first + j) * part + v]);
            out[k * part + v] = static_cast<float>(sum);
        }
    }
    return out;
}

}  // namespace edgesplat::detail
