// An outline in a pixel, and how pixels beside it are blended (docs/method/smoothing.md, Outlines). Written in the subset of
// GLSL that is C++. The includer declares outline_offset(ivec2 pixel), the offset of a pixel's outline along its axis, 0 without
// one or outside the picture, and drawn_at(ivec2 pixel), the pixel nearest to a position of the picture with one ray a pixel.
#ifndef EDGESPLAT_PIXEL_OUTLINE_GLSL
#define EDGESPLAT_PIXEL_OUTLINE_GLSL

// Adds the neighbour's share to a pixel if an outline passes between their centres. The picture on both sides is
// extrapolated to the outline, and only the remaining step counts, clamped to the difference. So a smooth picture does
// not change.
vec4 with_other_side(vec4 own, ivec2 pixel) {
    vec2 offset = outline_offset(pixel);
    ivec2 towards = ivec2(0);
    Real nearest = 0.5;
    for (int k = 0; k < 4; ++k) {
        ivec2 step = ivec2(k == 0 ? 1 : (k == 1 ? -1 : 0), k == 2 ? 1 : (k == 3 ? -1 : 0));
        Real ours = dot(offset, vec2(step));
        Real theirs = -dot(outline_offset(pixel + step), vec2(step));
        // If both pixels store an outline, it lies between their two offsets. A pixel with an outline elsewhere ignores
        // its neighbour's.
        bool both = ours > 0.0 && theirs > 0.0;
        bool alone = theirs > 0.0 && offset == vec2(0.0);
        Real at = both ? ours / (ours + theirs) : (ours > 0.0 ? ours : (alone ? 1.0 - theirs : Real(1.0)));
        towards = at < nearest ? step : towards;
        nearest = min(nearest, at);
    }
    vec4 next = drawn_at(pixel + towards);
    vec4 difference = next - own;
    vec4 here = own - drawn_at(pixel - towards);
    vec4 there = drawn_at(pixel + 2 * towards) - next;
    vec4 jump = difference - nearest * here - (1.0 - nearest) * there;
    return own + (Real(0.5) - nearest) * clamp(jump, min(difference, vec4(0.0)), max(difference, vec4(0.0)));
}
#endif
