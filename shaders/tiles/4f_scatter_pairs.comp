// Parallel sort, last step: writes every pair of a splat and an unsaturated tile to its position. One workgroup per
// block. Each pair counts the entries before it that touch the same tile, so that lists keep the order of the sheets.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/tiles/pairs_of_block.glsl"
#include "shaders/splats/sheet_of_entry.glsl"
STORED_PAIRS(BIND_TILE_ENTRIES, entries_by_tile, tile_entries, load_entry, store_entry)
TEXEL_PAIRS(BIND_TILE_RANGES, ranges, tile_ranges, load_range)

shared uint sheets[PAIR_GROUP];  // sheet of each entry

bool touches(uvec4 rect, uvec2 tile) {
    return all(lessThanEqual(rect.xy, tile)) && all(lessThan(tile, rect.zw));
}

void main() {
    uint block = gl_WorkGroupID.x, me = gl_LocalInvocationIndex;
    uvec2 entries = entries_of_block(block);
    CountersRef counters = CountersRef(params.frame.tile_counters);
    for (uint base = entries.x; base < entries.y; base += PAIR_GROUP) {
        uint pairs = load_pairs(base, entries.y);
        sheets[me] = sheet_of_entry(base + me);
        barrier();
        for (uint n = me; n < pairs; n += PAIR_GROUP) {
            Pair pair = pair_of(n);
            uint tile = tile_number(pair.tile), before = 0u;
            if (is_closed(tile)) continue;
            for (uint i = 0u; i < pair.k; ++i) before += touches(rects[i], pair.tile) ? 1u : 0u;
            uint place = load_range(tile).x + counters.at[tile * params.frame.tile_blocks + block] + before;
            store_entry(params.frame.entries_first + place, uvec2(base + pair.k, sheets[pair.k]));
        }
        memoryBarrierBuffer();
        barrier();
        for (uint n = me; n < pairs; n += PAIR_GROUP) {
            uint tile = tile_number(pair_of(n).tile);
            if (!is_closed(tile)) atomicAdd(counters.at[tile * params.frame.tile_blocks + block], 1u);
        }
        memoryBarrierBuffer();
        barrier();
    }
}
