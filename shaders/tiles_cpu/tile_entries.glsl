// Iterates over a chunk's splats in the order of their sheets, to sort them into tiles. Each invocation owns a block of
// consecutive entries and one column of the histogram, so there is no race and the order is kept.
#include "shaders/drivers/if_any.glsl"
#include "shaders/drivers/iterations.h"
#include "shaders/shared/bindings.h"
#include "shaders/shared/frame_params.h"

layout(local_size_x = 16) in;  // there are few columns: a larger workgroup would leave processors idle
#include "shaders/common/groups.glsl"
#include "shaders/common/frame.glsl"
#include "shaders/drivers/texels.glsl"
STORED_WORDS(BIND_TILE_COUNTERS, counters, tile_counters, count_at, set_count)
layout(push_constant) uniform Push { uint chunk; };
#include "shaders/tiles/tiles_of_splat.glsl"

struct Block {
    uint first, last;  // entries of `order`
    uint column;
};

Block block_of_invocation() {
    uint column = invocation_number();
    uvec2 entries = entries_of_block(column);
    return Block(entries.x, column < params.frame.tile_blocks ? entries.y : entries.x, column);
}

// The pairs of a block, one after another, PAIR_STEPS per dispatch; the next dispatch continues at the end of this one.
// The splats of a chunk differ in size, so that one column may have many times the pairs of another.
struct Pairs {
    uint entry, k;      // index into `order`; index of the tile within the splat
    uint number;        // of the splat
    uvec4 tiles;
    uint across, count;
};

void load_entry(inout Pairs pairs, Block block) {
    pairs.number = UintsRef(params.frame.order).at[min(pairs.entry, block.last - 1u)];
    pairs.tiles = tiles_of(pairs.number);
    pairs.across = max(pairs.tiles.z - pairs.tiles.x, 1u);
    pairs.count = pairs.across * (pairs.tiles.w - pairs.tiles.y);
}

uint column_state(uint column, uint part) {
    return uint(params.frame.tiles.x * params.frame.tiles.y) * params.frame.tile_blocks + column * COLUMN_STATE + 2u * part;
}

// `part`: 0 counting, 1 scattering.
Pairs begin_pairs(Block block, uint part) {
    uint at = column_state(block.column, part);
    Pairs pairs;
    pairs.entry = block.first;
    pairs.k = 0u;
    IF_ANY(block.first < block.last) {
        pairs.entry += count_at(at);
        pairs.k = count_at(at + 1u);
        load_entry(pairs, block);
    }
    return pairs;
}

uvec2 tile_of(Pairs pairs) { return uvec2(pairs.tiles.x + pairs.k % pairs.across, pairs.tiles.y + pairs.k / pairs.across); }

void next_pair(inout Pairs pairs, Block block) {
    ++pairs.k;
    if (pairs.k >= pairs.count) {
        pairs.k = 0u;
        ++pairs.entry;
        load_entry(pairs, block);
    }
}

void end_pairs(Pairs pairs, Block block, uint part) {
    uint at = column_state(block.column, part);
    IF_ANY(block.first < block.last) {
        set_count(at, pairs.entry - block.first);
        set_count(at + 1u, pairs.k);
    }
}
