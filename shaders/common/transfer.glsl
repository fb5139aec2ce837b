// Colour and extinction of a value: exact between the points of the transfer function. docs/method.md, Transfer
// functions.
#ifndef EDGESPLAT_TRANSFER_GLSL
#define EDGESPLAT_TRANSFER_GLSL
#include "shaders/shared/transfer_rows.h"

vec4 transfer_at(TransferRef rows, float value) {
    uint i = 0u;
    for (uint step = TRANSFER_ROWS / 2u; step > 0u; step >>= 1) i += rows.at[i + step].value <= value ? step : 0u;
    float low = rows.at[i].value, high = rows.at[i + 1u].value;
    float t = clamp((value - low) / (high - low), 0.0, 1.0);
    return mix(rows.at[i].matter, rows.at[i + 1u].matter, t);
}
#endif
