// GLSL's functions and types, for the GLSL files of this folder in double precision.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace edgesplat::in_double {

using uint = std::uint32_t;

inline double abs(double v) {
    return std::abs(v);
}
inline double sqrt(double v) {
    return std::sqrt(v);
}
inline double inversesqrt(double v) {
    return 1 / std::sqrt(v);
}
inline double min(double a, double b) {
    return std::min(a, b);
}
inline double max(double a, double b) {
    return std::max(a, b);
}
inline double clamp(double v, double low, double high) {
    return std::min(std::max(v, low), high);
}

}  // namespace edgesplat::in_double
