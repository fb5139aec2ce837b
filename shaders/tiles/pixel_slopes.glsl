// Slopes of a pixel's ray: right and down per depth.
#ifndef EDGESPLAT_PIXEL_SLOPES_GLSL
#define EDGESPLAT_PIXEL_SLOPES_GLSL
vec2 slopes_of(ivec2 pixel) {
    return ((vec2(pixel) + 0.5) * 2.0 / vec2(params.frame.size) - 1.0) * vec2(params.frame.tan_half_x, params.frame.tan_half_y);
}
#endif
