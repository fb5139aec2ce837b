// Composites the surfaces that no sheet of kernels passed behind the picture. docs/method.md, 6_join_surfaces.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/shared/bindings.h"
#include "shaders/shared/frame_params.h"

layout(local_size_x = 64) in;
#include "shaders/common/groups.glsl"
#include "shaders/common/frame.glsl"
#include "shaders/drivers/texels.glsl"
STORED_PIXELS(BIND_PICTURE, picture, output_pixels, load_pixel, store_pixel)
#include "shaders/tiles/seen_surfaces.glsl"

void main() {
    uint at = invocation_number();
    if (at >= uint(params.frame.size.x * params.frame.size.y)) return;
    vec4 sum = load_pixel(at);
    SeenWays ways = seen_ways(at);
    pass_surfaces(sum, ways, at, NEVER_SEEN);
    store_pixel(at, sum);
}
