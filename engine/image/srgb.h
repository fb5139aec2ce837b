// The transfer curve of sRGB (IEC 61966-2-1), per channel, for 0..1; the same formulas apply beyond.
#pragma once

#include <cmath>
#include <concepts>

namespace edgesplat {

template <std::floating_point T>
T to_srgb(T linear) {
    return linear <= T(0.0031308) ? T(12.92) * linear : T(1.055) * std::pow(linear, T(1) / T(2.4)) - T(0.055);
}

template <std::floating_point T>
T to_linear(T srgb) {
    return srgb <= T(0.04045) ? srgb / T(12.92) : std::pow((srgb + T(0.055)) / T(1.055), T(2.4));
}

}  // namespace edgesplat
