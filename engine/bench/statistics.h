// What repeated measurements come to.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <utility>
#include <vector>

namespace edgesplat::bench {

/// Of repeated measurements of one thing. NaN of none.
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

/// Least squares in logarithms. Points with a coordinate that is not above 0 are left out; nothing where fewer than two
/// different x are left.
std::optional<PowerFit> fit_power(std::span<const std::pair<double, double>> points);

}  // namespace edgesplat::bench
