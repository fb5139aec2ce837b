#include "engine/bench/statistics.h"

#include <cmath>

#include "engine/accuracy/metrics.h"

namespace edgesplat::bench {

Sampled sampled(const std::vector<double>& values) {
    using accuracy::quantile;
    return {quantile(values, 0.5), quantile(values, 0.95), quantile(values, 0.1), quantile(values, 0.9), values.size()};
}

std::optional<PowerFit> fit_power(std::span<const std::pair<double, double>> points) {
    std::vector<std::pair<double, double>> logs;
    for (const auto& [x, y] : points)
        if (x > 0 && y > 0 && std::isfinite(x) && std::isfinite(y)) logs.emplace_back(std::log(x), std::log(y));
    if (logs.empty()) return std::nullopt;
    const auto n = static_cast<double>(logs.size());
    double mean_x = 0, mean_y = 0;
    for (const auto& [x, y] : logs) {
        mean_x += x / n;
        mean_y += y / n;
    }
    double xx = 0, xy = 0;
    for (const auto& [x, y] : logs) {
        xx += (x - mean_x) * (x - mean_x);
        xy += (x - mean_x) * (y - mean_y);
    }
    if (!(xx > 0)) return std::nullopt;
    PowerFit fit{xy / xx, 0, 0, logs.size()};
    const double offset = mean_y - fit.exponent * mean_x;
    fit.factor = std::exp(offset);
    double squares = 0;
    for (const auto& [x, y] : logs) {
        const double off = y - offset - fit.exponent * x;
        squares += off * off;
    }
    fit.residual = std::sqrt(squares / n);
    return fit;
}

}  // namespace edgesplat::bench
