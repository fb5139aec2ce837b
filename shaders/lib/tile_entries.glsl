// The walk over a chunk's splats, in the order of their sheets, by which tiles get theirs: each invocation owns a block of
// consecutive entries and one column of the histogram, so there is no race and the order stays.
#include "shaders/shared/bindings.h"
#include "shaders/shared/frame_params.h"

layout(local_size_x = 64) in;
layout(binding = BIND_FRAME, scalar) uniform Frame { FrameParams frame; } params;
layout(push_constant) uniform Push { uint chunk; };

struct Block {
    uint first, last;  // entries of `order`
    uint column;
};

Block block_of_invocation() {
    uvec2 all = PairsRef(params.frame.chunks).at[chunk];
    uint per_block = (all.y - all.x + params.frame.tile_blocks - 1u) / params.frame.tile_blocks;
    uint column = gl_GlobalInvocationID.x;
    uint first = min(all.x + column * per_block, all.y);
    return Block(first, column < params.frame.tile_blocks ? min(first + per_block, all.y) : first, column);
}

// Tiles that a splat touches: x0, y0, x1, y1, half open.
uvec4 tiles_of(uint number) {
    uvec2 code = PairsRef(params.frame.tile_rects).at[number];
    return uvec4(code.x & 0xffffu, code.x >> 16, code.y & 0xffffu, code.y >> 16);
}

// Whether no pixel of a tile takes more.
bool is_closed(uint x, uint y) {
    uvec2 pixels = min(uvec2(TILE), uvec2(params.frame.size) - TILE * uvec2(x, y));
    return UintsRef(params.frame.tile_closed).at[y * uint(params.frame.tiles.x) + x] == pixels.x * pixels.y;
}
