// After shaders that declare REFINED.
// Blocks that entries are marked for, row by row. Refined pixels lie apart.
const uvec2 BLOCK = uvec2(4u, REFINED == 1u ? 4u : 2u);
const uint BLOCKS = TILE * TILE / (BLOCK.x * BLOCK.y);

uvec2 block_corner(uint block) { return BLOCK * uvec2(block % (TILE / BLOCK.x), block / (TILE / BLOCK.x)); }
uint block_of(ivec2 pixel) {
    uvec2 in_tile = uvec2(pixel) % TILE / BLOCK;
    return in_tile.x + TILE / BLOCK.x * in_tile.y;
}

// Of a list's entries, the first that a round draws.
uint round_begin(uint draw_round) { return draw_round == 0u ? 0u : TILE_FIRST_ROUND + (draw_round - 1u) * TILE_ROUND; }
