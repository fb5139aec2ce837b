// Parallel sort, step 2: prefix sums over the blocks of a tile, and the tile's total. One workgroup per tile.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/shared/bindings.h"
#include "shaders/shared/frame_params.h"

layout(local_size_x = 256) in;
#include "shaders/common/groups.glsl"
#include "shaders/common/frame.glsl"
#include "shaders/drivers/texels.glsl"
STORED_PAIRS(BIND_TILE_RANGES, ranges, tile_ranges, load_range, store_range)
#include "shaders/common/row_sums.glsl"

void main() {
    uint tile = group_number();
    if (tile >= uint(params.frame.tiles.x * params.frame.tiles.y)) return;
    uint sum = sum_row(UintsRef(params.frame.tile_counters), tile * params.frame.tile_blocks, params.frame.tile_blocks);
    if (gl_LocalInvocationIndex == 0u) store_range(tile, uvec2(sum, 0u));
}
