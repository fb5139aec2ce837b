// Parallel sort of a chunk's splats into tiles, step 1: counts the splats of each block in each tile. The order of
// additions does not change the counts. A workgroup processes PAIR_GROUP entries of a block at a time.
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
