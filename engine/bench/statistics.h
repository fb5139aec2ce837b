// Statistics of repeated measurements.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <utility>
#include <vector>

namespace edgesplat::bench {

/// Statistics of repeated measurements of one quantity. NaN without values.
struct Sampled {
    double median = 0, p95 = 0;
    double low = 0, high = 0;  ///< p10 and p90
    std::size_t count = 0;
};
Sampled sampled(const std::vector<double>& values);

/// y = factor x^exponent.
struct PowerFit {
    double exponent = 0, factor = 0;
    double residual = 0;  ///< RMS of ln(y / fit)
    std::size_t points = 0;
};

/// Least-squares fit of the logarithms. Points with a coordinate <= 0 are left out; nullopt if fewer than two different
/// x remain.
std::optional<PowerFit> fit_power(std::span<const std::pair<double, double>> points);

}  // namespace edgesplat::bench
