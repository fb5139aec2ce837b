// Sort of a chunk's splats into tiles, step 1 of 3: counts the splats of each block in each tile. docs/method.md, pass
// 4.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/tiles_cpu/tile_entries.glsl"

void main() {
    Block block = block_of_invocation();
    Pairs pairs = begin_pairs(block, 0u);
    for (uint n = 0u; n < PAIR_STEPS && pairs.entry < block.last; ++n) {
        uvec2 at = tile_of(pairs);
        uint tile = at.y * uint(params.frame.tiles.x) + at.x;
        uint place = tile * params.frame.tile_blocks + block.column;
        set_count(place, count_at(place) + (is_closed(tile) ? 0u : 1u));
        next_pair(pairs, block);
    }
    end_pairs(pairs, block, 0u);
}
