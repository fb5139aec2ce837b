// An outline in a pixel. The including shader declares the uniform block `params.frame`.
#ifndef EDGESPLAT_OUTLINE_WORD_GLSL
#define EDGESPLAT_OUTLINE_WORD_GLSL
#include "footprints/in_float.glsl"
#include "engine/geometry/outline_place.glsl"

// Packs an outline. The matter lies where `level` < 0; `rate`: change of `level` per pixel to the right and down. Of
// two words the smaller counts, since matter of either splat is matter of both.
// Bits: level in pixels from -1 (12) | axis is down (1) | offset along the axis, pixels, from -1 (16)
uint outline_word(float level, vec2 rate) {
    OutlinePlace place = outline_place(level, rate);
    uint word = uint(clamp(0.5 * place.level + 0.5, 0.0, 1.0) * 4095.0) << 17 | (place.down ? 1u << 16 : 0u) |
                uint(clamp(0.5 * place.offset + 0.5, 0.0, 1.0) * 65535.0);
    return place.there ? word : NO_OUTLINE;
}

// Change of a function with this gradient, at a depth (mm), from a pixel to the next to the right and to the next
// below.
vec2 rate_across(vec3 gradient, float depth) {
    vec2 pixel = 2.0 * depth * vec2(params.frame.tan_half_x, params.frame.tan_half_y) / vec2(params.frame.size);
    return pixel * vec2(dot(gradient, params.of_volume.ray_x), dot(gradient, params.of_volume.ray_y));
}
#endif
