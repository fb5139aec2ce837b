// Blends a pixel at an outline with its neighbour. docs/method.md, 7_resolve. Include after the declarations of
// load_outline and load_before, which read the picture with one ray per pixel.
#ifndef EDGESPLAT_OTHER_SIDE_GLSL
#define EDGESPLAT_OTHER_SIDE_GLSL

ivec2 held_pixel(ivec2 pixel, ivec2 size) { return clamp(pixel, ivec2(0), size - 1); }

vec4 drawn_at(ivec2 pixel, ivec2 size) {
    ivec2 held = held_pixel(pixel, size);
    return load_before(held.y * size.x + held.x);
}

// Offset of a pixel's outline along its axis, pixels; 0 without an outline.
vec2 outline_offset(ivec2 pixel, ivec2 size) {
    ivec2 held = held_pixel(pixel, size);
    uint word = load_outline(held.y * size.x + held.x);
    float offset = float(word & 0xffffu) / 65535.0 * 2.0 - 1.0;
    return word == NO_OUTLINE || held != pixel ? vec2(0.0) : (word >> 16 & 1u) == 1u ? vec2(0.0, offset) : vec2(offset, 0.0);
}

// Adds the neighbour's share to a pixel if an outline passes between their centres. The picture on both sides is
// extrapolated to the outline, and only the remaining step counts, clamped to the difference. So a smooth picture does
// not change.
vec4 with_other_side(vec4 own, ivec2 pixel, ivec2 size) {
    vec2 offset = outline_offset(pixel, size);
    ivec2 towards = ivec2(0);
    float nearest = 0.5;
    for (int k = 0; k < 4; ++k) {
        ivec2 step = ivec2(k == 0 ? 1 : k == 1 ? -1 : 0, k == 2 ? 1 : k == 3 ? -1 : 0);
        float ours = dot(offset, vec2(step)), theirs = -dot(outline_offset(pixel + step, size), vec2(step));
        // If both pixels store an outline, it lies between their two offsets. A pixel with an outline elsewhere ignores
        // its neighbour's.
        bool both = ours > 0.0 && theirs > 0.0, alone = theirs > 0.0 && offset == vec2(0.0);
        float at = both ? ours / (ours + theirs) : ours > 0.0 ? ours : alone ? 1.0 - theirs : 1.0;
        towards = at < nearest ? step : towards;
        nearest = min(nearest, at);
    }
    vec4 next = drawn_at(pixel + towards, size), difference = next - own;
    vec4 here = own - drawn_at(pixel - towards, size), there = drawn_at(pixel + 2 * towards, size) - next;
    vec4 jump = difference - nearest * here - (1.0 - nearest) * there;
    return own + (0.5 - nearest) * clamp(jump, min(difference, 0.0), max(difference, 0.0));
}
#endif
