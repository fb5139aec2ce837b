// Step 3 of 3: writes every pair of a splat and an unsaturated tile to its position, sheet by sheet.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/tiles_cpu/tile_entries.glsl"
#include "shaders/splats/sheet_of_entry.glsl"
STORED_PAIRS(BIND_TILE_ENTRIES, entries, tile_entries, load_entry, store_entry)

void main() {
    Block block = block_of_invocation();
    UintsRef starts = UintsRef(params.frame.sheet_starts);
    Pairs pairs = begin_pairs(block, 1u);
    uint sheet = sheet_of_entry(pairs.entry);
    for (uint n = 0u; n < PAIR_STEPS && pairs.entry < block.last; ++n) {
        while (starts.at[sheet + 1u] <= pairs.entry) ++sheet;
        uvec2 at = tile_of(pairs);
        uint tile = at.y * uint(params.frame.tiles.x) + at.x;
        if (!is_closed(tile)) {
            uint place = tile * params.frame.tile_blocks + block.column, pair = count_at(place);
            set_count(place, pair + 1u);
            store_entry(params.frame.entries_first + pair, uvec2(pairs.entry, sheet));
        }
        next_pair(pairs, block);
    }
    end_pairs(pairs, block, 1u);
}
