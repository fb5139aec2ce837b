// Parallel sort, step 3: begin and end of each tile's list. One workgroup; each invocation processes a run of tiles.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/shared/bindings.h"
#include "shaders/shared/frame_params.h"

layout(local_size_x = 256) in;
#include "shaders/common/frame.glsl"
#include "shaders/drivers/texels.glsl"
STORED_PAIRS(BIND_TILE_RANGES, ranges, tile_ranges, load_range, store_range)
#include "shaders/common/workgroup_sums.glsl"
#include "shaders/tiles/begin_of_list.glsl"

void main() {
    uint me = gl_LocalInvocationIndex, tiles = uint(params.frame.tiles.x * params.frame.tiles.y);
    uint per_run = (tiles + 255u) / 256u, first = min(me * per_run, tiles), last = min(first + per_run, tiles);
    uint sum = 0u;
    for (uint tile = first; tile < last; ++tile) sum += begin_of_list(load_range(tile).x);
    uint begin = sum_before(sum);
    for (uint tile = first; tile < last; ++tile) {
        uint end = begin + load_range(tile).x;
        store_range(tile, uvec2(begin, end));
        begin = begin_of_list(end);
    }
}
