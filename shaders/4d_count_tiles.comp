// Splats of a chunk to the tiles that they touch, first third: how many of each block touch each tile. docs/method.md, pass 4.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/lib/tile_entries.glsl"

void main() {
    Block block = block_of_invocation();
    UintsRef order = UintsRef(params.frame.order), counters = UintsRef(params.frame.tile_counters);
    for (uint i = block.first; i < block.last; ++i) {
        uvec4 tiles = tiles_of(order.at[i]);
        uint across = tiles.z - tiles.x, count = across * (tiles.w - tiles.y);
        for (uint k = 0u; k < count; ++k) {
            uint x = tiles.x + k % across, y = tiles.y + k / across;
            uint tile = y * uint(params.frame.tiles.x) + x;
            counters.at[tile * params.frame.tile_blocks + block.column] += is_closed(x, y) ? 0u : 1u;
        }
    }
}
