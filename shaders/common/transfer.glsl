// Colour and extinction of a value; exact between the points of the transfer function. docs/method.md, Transfer
// functions.
#ifndef EDGESPLAT_TRANSFER_GLSL
#define EDGESPLAT_TRANSFER_GLSL
#include "shaders/shared/transfer_rows.h"

// The last row whose value is at most `value`; the first row if there is none.
uint transfer_row(TransferRef rows, float value) {
    uint i = 0u;
    for (uint step = TRANSFER_ROWS / 2u; step > 0u; step >>= 1) i += rows.at[i + step].value <= value ? step : 0u;
    return i;
}

vec4 transfer_in_row(TransferRef rows, uint i, float value) {
    float low = rows.at[i].value, high = rows.at[i + 1u].value;
    float t = clamp((value - low) / (high - low), 0.0, 1.0);
    return mix(rows.at[i].matter, rows.at[i + 1u].matter, t);
}

vec4 transfer_at(TransferRef rows, float value) { return transfer_in_row(rows, transfer_row(rows, value), value); }

// Integral of extinction * (rgb, 1) over an interval within one row. Both factors are linear there, so Simpson's rule
// is exact.
vec4 transfer_over_row(TransferRef rows, uint i, float low, float high) {
    vec4 a = transfer_in_row(rows, i, low), b = transfer_in_row(rows, i, 0.5 * (low + high)), c = transfer_in_row(rows, i, high);
    return (high - low) / 6.0 * (a.a * vec4(a.rgb, 1.0) + 4.0 * b.a * vec4(b.rgb, 1.0) + c.a * vec4(c.rgb, 1.0));
}

// Mean of extinction * (rgb, 1) over the values between `from` and `to`. Exact, and free of cancellation if both are
// close to each other.
vec4 transfer_between(TransferRef rows, float from, float to) {
    float low = min(from, to), high = max(from, to), first = rows.at[0].value;
    uint i = transfer_row(rows, low), j = transfer_row(rows, high);
    vec4 below = max(min(high, first) - low, 0.0) * rows.at[0].matter.a * vec4(rows.at[0].matter.rgb, 1.0);
    float begin = max(low, first), end = max(high, first);
    vec4 sum = i == j ? transfer_over_row(rows, i, begin, end)
                      : transfer_over_row(rows, i, begin, rows.at[i + 1u].value) + rows.at[j].before - rows.at[i + 1u].before +
                            transfer_over_row(rows, j, rows.at[j].value, end);
    vec4 here = transfer_at(rows, low);
    return high > low ? (below + sum) / (high - low) : here.a * vec4(here.rgb, 1.0);
}
#endif
