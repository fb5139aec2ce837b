TEXEL_WORDS(BIND_TILE_CLOSED, closed_pixels, tile_closed, load_closed)
TEXEL_WORDS(BIND_TILE_TODO, todo_pixels, tile_todo, load_todo)

// Tiles that a splat touches: x0, y0, x1, y1, half open.
uvec4 tiles_of(uint number) {
    uvec2 code = PairsRef(params.frame.tile_rects).at[number];
    return uvec4(code.x & 0xffffu, code.x >> 16, code.y & 0xffffu, code.y >> 16);
}

// Whether a tile is saturated: all of its drawn pixels are.
bool is_closed(uint tile) { return load_closed(tile) == load_todo(tile); }

// Entries of a block of the chunk, half open.
uvec2 entries_of_block(uint block) {
    uvec2 all = PairsRef(params.frame.chunks).at[chunk];
    uint per_block = (all.y - all.x + params.frame.tile_blocks - 1u) / params.frame.tile_blocks;
    uint first = min(all.x + block * per_block, all.y);
    return uvec2(first, min(first + per_block, all.y));
}
