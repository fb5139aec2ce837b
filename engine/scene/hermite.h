// Cubic Hermite curves through keys in time, without overshoot, for scalars and 3-D vectors.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <glm/glm.hpp>
#include <vector>

namespace edgesplat::hermite {

inline double length(double v) {
    return std::abs(v);
}
inline double length(const glm::dvec3& v) {
    return glm::length(v);
}
inline double dot(double a, double b) {
    return a * b;
}
inline double dot(const glm::dvec3& a, const glm::dvec3& b) {
    return glm::dot(a, b);
}

/// Values at ascending times. `closed`: the last value repeats the first, and the curve is smooth there.
template <typename T>
struct Keys {
    std::vector<double> times;
    std::vector<T> values;
    bool closed = false;
};

/// The cubic Hermite weights at u in [0, 1]: of both values, and of both rates times the interval's length.
struct Weights {
    double first, second, first_rate, second_rate;
    explicit Weights(double u)
        : first((1 + 2 * u) * (1 - u) * (1 - u)),
          second(u * u * (3 - 2 * u)),
          first_rate(u * (1 - u) * (1 - u)),
          second_rate(u * u * (u - 1)) {}
};

/// Rate at a key between intervals of lengths h0, h1 with slopes slope0, slope1. It is the rate of the parabola through
/// the three values, at most three times the smaller slope, and tends to 0 where the direction reverses. For numbers
/// this satisfies Fritsch and Carlson's condition (1980) for a monotone curve; for vectors it is equivariant under
/// rotation.
template <typename T>
T rate_between(const T& slope0, double h0, const T& slope1, double h1) {
    const double a = length(slope0), b = length(slope1);
    if (!(a > 0 && b > 0)) return T(0);
    T rate = (slope0 * h1 + slope1 * h0) / (h0 + h1);
    const double cosine = dot(slope0 / a, slope1 / b);
    if (cosine < 0) rate *= std::max(0.0, 1 - cosine * cosine);
    const double size = length(rate), most = 3 * std::min(a, b);
    return size > most ? rate * (most / size) : rate;
}

/// Rate at an end of a curve from the slope there and the next slope: that of the parabola, never in the opposite
/// direction.
template <typename T>
T rate_at_end(const T& slope, double h, const T& next, double next_h) {
    T rate = slope + (slope - next) * (h / (h + next_h));
    const double size = length(rate), most = 3 * length(slope);
    if (!(dot(rate, slope) > 0)) return T(0);
    return size > most ? rate * (most / size) : rate;
}

/// Rate of the curve at key i.
template <typename T>
T rate(const Keys<T>& keys, std::size_t i) {
    const std::size_t last = keys.times.size() - 1;
    if (last == 0) return T(0);
    const auto h = [&](std::size_t k) { return keys.times[k + 1] - keys.times[k]; };
    const auto slope = [&](std::size_t k) { return (keys.values[k + 1] - keys.values[k]) / h(k); };
    if (i > 0 && i < last) return rate_between(slope(i - 1), h(i - 1), slope(i), h(i));
    if (keys.closed) return rate_between(slope(last - 1), h(last - 1), slope(0), h(0));
    if (last == 1) return slope(0);
    return i == 0 ? rate_at_end(slope(0), h(0), slope(1), h(1))
                  : rate_at_end(slope(last - 1), h(last - 1), slope(last - 2), h(last - 2));
}

/// The curve between keys i and i + 1 at a fraction u in [0, 1].
template <typename T>
T value(const Keys<T>& keys, std::size_t i, double u) {
    const Weights w(u);
    const double h = keys.times[i + 1] - keys.times[i];
    const T& from = keys.values[i];
    const T& to = keys.values[i + 1];
    // Evaluated from the nearer end: both ends, and constant intervals, are exact.
    const T straight = u < 0.5 ? from + (to - from) * w.second : to - (to - from) * w.first;
    return straight + (rate(keys, i) * w.first_rate + rate(keys, i + 1) * w.second_rate) * h;
}

}  // namespace edgesplat::hermite
