// Pixels and outlines for the blend of pixels beside outlines. docs/method.md, 7_resolve. Include after the declarations of
// load_outline and load_before, which read the picture with one ray per pixel, and of the uniform block `params.frame`.
#ifndef EDGESPLAT_OTHER_SIDE_GLSL
#define EDGESPLAT_OTHER_SIDE_GLSL

ivec2 held_pixel(ivec2 pixel) { return clamp(pixel, ivec2(0), params.frame.size - 1); }

vec4 drawn_at(ivec2 pixel) {
    ivec2 held = held_pixel(pixel);
    return load_before(held.y * params.frame.size.x + held.x);
}

vec2 outline_offset(ivec2 pixel) {
    ivec2 held = held_pixel(pixel);
    uint word = load_outline(held.y * params.frame.size.x + held.x);
    float offset = float(word & 0xffffu) / 65535.0 * 2.0 - 1.0;
    return word == NO_OUTLINE || held != pixel ? vec2(0.0) : (word >> 16 & 1u) == 1u ? vec2(0.0, offset) : vec2(offset, 0.0);
}
#include "footprints/in_float.glsl"
#include "engine/geometry/pixel_outline.glsl"
#endif
