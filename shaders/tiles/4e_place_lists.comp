// Third step: where each tile's list begins and ends. One workgroup: each invocation has a run of tiles.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/shared/bindings.h"
#include "shaders/shared/frame_params.h"

layout(local_size_x = 256) in;
layout(binding = BIND_FRAME, scalar) uniform Frame { FrameParams frame; } params;
layout(binding = BIND_TILE_RANGES, rg32ui) uniform uimageBuffer ranges;
#include "shaders/common/workgroup_sums.glsl"
#include "shaders/tiles/begin_of_list.glsl"

void main() {
    uint me = gl_LocalInvocationIndex, tiles = uint(params.frame.tiles.x * params.frame.tiles.y);
    uint per_run = (tiles + 255u) / 256u, first = min(me * per_run, tiles), last = min(first + per_run, tiles);
    uint sum = 0u;
    for (uint tile = first; tile < last; ++tile) sum += begin_of_list(imageLoad(ranges, int(tile)).x);
    uint begin = sum_before(sum);
    for (uint tile = first; tile < last; ++tile) {
        uint end = begin + imageLoad(ranges, int(tile)).x;
        imageStore(ranges, int(tile), uvec4(begin, end, 0u, 0u));
        begin = begin_of_list(end);
    }
}
