// Converts accumulated sheets into the picture that the host reads: adds the background to colours, and computes means
// of the other quantities.
// docs/method.md, pass 7.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/shared/bindings.h"
#include "shaders/shared/frame_params.h"

layout(local_size_x = 8, local_size_y = 8) in;
layout(constant_id = SPEC_PAYLOAD) const uint PAYLOAD = 0u;
layout(constant_id = SPEC_GRADIENT) const uint GRADIENT = 0u;
layout(constant_id = SPEC_TILES) const uint TILES = 1u;
layout(constant_id = SPEC_OUTLINES) const uint OUTLINES = 0u;
layout(binding = BIND_ACCUMULATED) uniform sampler2D accumulated;
#include "shaders/common/frame.glsl"
#include "shaders/drivers/texels.glsl"
STORED_PIXELS(BIND_PICTURE, picture, output_pixels, load_pixel, store_pixel)
TEXEL_PIXELS(BIND_TILE_SHEETS, before, tile_sheets, load_before)  // the picture before this pass
TEXEL_WORDS(BIND_OUTLINES, passing, outlines, load_outline)
#include "shaders/resolve/other_side.glsl"

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy), size = params.frame.size;
    if (any(greaterThanEqual(pixel, size))) return;
    int at = pixel.y * size.x + pixel.x;
    vec4 sum = vec4(0.0);
    if (TILES == 1u) sum = load_pixel(at);
    else sum = texelFetch(accumulated, pixel, 0);
    if (OUTLINES == 1u) sum = with_other_side(sum, pixel);
    if (PAYLOAD == PAYLOAD_COLOR) {
        vec3 behind = params.frame.background;
        if (GRADIENT == 1u) {
            float height = float(size.y - 1 - pixel.y) / max(float(size.y - 1), 1.0);
            behind = mix(behind, params.frame.background_top, height);
        }
        sum.rgb += (1.0 - sum.a) * behind;
    }
    if (PAYLOAD == PAYLOAD_DEPTH_DISTANCE) sum.rgb = sum.a > 0.0 ? sum.rgb / sum.a : vec3(0.0);
    if (PAYLOAD == PAYLOAD_NORMAL) {
        // Scaled first: for faint pixels the squares would underflow.
        float largest = max(abs(sum.r), max(abs(sum.g), abs(sum.b)));
        sum.rgb = largest > 0.0 ? normalize(sum.rgb / largest) : vec3(0.0);
    }
    store_pixel(at, sum);
}
