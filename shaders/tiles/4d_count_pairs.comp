// Splats of a chunk to the tiles that they touch, side by side. First step: how many of each block touch each tile; the order in
// which they come changes no count. A workgroup has PAIR_GROUP entries of a block.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/tiles/pairs_of_block.glsl"

void main() {
    uint block = gl_WorkGroupID.x;
    uvec2 entries = entries_of_block(block);
    for (uint base = entries.x; base < entries.y; base += PAIR_GROUP) {
        uint pairs = load_pairs(base, entries.y);
        for (uint n = gl_LocalInvocationIndex; n < pairs; n += PAIR_GROUP) {
            uint tile = tile_number(pair_of(n).tile);
            if (!is_closed(tile)) atomicAdd(UintsRef(params.frame.tile_counters).at[tile * params.frame.tile_blocks + block], 1u);
        }
    }
}
