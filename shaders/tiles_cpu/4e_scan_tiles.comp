// Step 2 of 3: exclusive prefix sum over (tile, block), and each tile's range. One workgroup: each invocation sums a
// run of counters; the runs are scanned in shared memory.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/shared/bindings.h"
#include "shaders/shared/frame_params.h"

layout(local_size_x = 256) in;
#include "shaders/common/frame.glsl"
#include "shaders/drivers/texels.glsl"
STORED_WORDS(BIND_TILE_COUNTERS, counters, tile_counters, load_counter, store_counter)
STORED_PAIRS(BIND_TILE_RANGES, ranges, tile_ranges, load_range, store_range)
#include "shaders/common/workgroup_sums.glsl"
#include "shaders/tiles/begin_of_list.glsl"


void main() {
    uint me = gl_LocalInvocationIndex, blocks = params.frame.tile_blocks;
    uint tiles = uint(params.frame.tiles.x * params.frame.tiles.y);
    uint per_run = (tiles + 255u) / 256u;
    uint first = min(me * per_run, tiles), last = min(first + per_run, tiles);

    uint sum = 0u;
    for (uint tile = first; tile < last; ++tile) {
        for (uint i = tile * blocks; i < tile * blocks + blocks; ++i) sum += load_counter(i);
        sum = begin_of_list(sum);
    }
    uint offset = sum_before(sum);
    for (uint tile = first; tile < last; ++tile) {
        uint begin = offset;
        for (uint i = tile * blocks; i < tile * blocks + blocks; ++i) {
            uint n = load_counter(i);
            store_counter(i, offset);
            offset += n;
        }
        store_range(tile, uvec2(begin, offset));
        offset = begin_of_list(offset);
    }
}
