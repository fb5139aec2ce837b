// Composites a sheet behind the sum of the sheets before it: docs/method.md, pass 6; design (10). The including shader
// declares PAYLOAD.
#ifndef EDGESPLAT_FOLD_SHEET_GLSL
#define EDGESPLAT_FOLD_SHEET_GLSL
#include "shaders/common/opacity.glsl"

// `sum`: premultiplied colour and opacity; `sheet`: (sum tau * colour, sum tau). Optical depths are only added.
vec4 folded(vec4 sum, vec4 sheet) {
    if (PAYLOAD == PAYLOAD_TAU) return sum + sheet;
    float alpha = opacity(sheet.a);
    vec3 color = sheet.a > 0.0 ? sheet.rgb / sheet.a : vec3(0.0);
    return sum + (1.0 - sum.a) * alpha * vec4(color, 1.0);
}
#endif
