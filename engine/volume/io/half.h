// Floats of 16 bits. Internal to engine/volume/io.
#pragma once

#include <cmath>
#include <cstdint>
#include <limits>

namespace edgesplat::detail {

/// A float with `exponent_bits` and `mantissa_bits` as IEEE 754 lays it out; exact.
inline float small_float(std::uint32_t bits, int exponent_bits, int mantissa_bits) {
    const std::uint32_t top = (1U << exponent_bits) - 1;
    const std::uint32_t exponent = (bits >> mantissa_bits) & top, mantissa = bits & ((1U << mantissa_bits) - 1);
    const int bias = static_cast<int>(top / 2) + mantissa_bits;
    double value = 0;
    if (exponent == top)
        value = mantissa != 0 ? std::numeric_limits<double>::quiet_NaN() : std::numeric_limits<double>::infinity();
    else if (exponent == 0)
        value = std::ldexp(static_cast<double>(mantissa), 1 - bias);
    else
        value = std::ldexp(static_cast<double>(mantissa + (1U << mantissa_bits)), static_cast<int>(exponent) - bias);
    return static_cast<float>(((bits >> (exponent_bits + mantissa_bits)) & 1) != 0 ? -value : value);
}

inline float float_of_half(std::uint16_t bits) {
    return small_float(bits, 5, 10);
}

}  // namespace edgesplat::detail
