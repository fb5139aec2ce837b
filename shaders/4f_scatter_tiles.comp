// Last third: every pair of a splat and a tile that is not opaque yet goes to its place, sheet by sheet.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/lib/tile_entries.glsl"

void main() {
    Block block = block_of_invocation();
    UintsRef order = UintsRef(params.frame.order), counters = UintsRef(params.frame.tile_counters);
    UintsRef starts = UintsRef(params.frame.sheet_starts);
    PairsRef entries = PairsRef(params.frame.tile_entries);
    // The last sheet that begins at or before the block's first entry.
    uint sheet = 0u;
    for (uint step = 1u << 16; step > 0u; step >>= 1)
        sheet += sheet + step < params.frame.sheet_count && starts.at[min(sheet + step, params.frame.sheet_count)] <= block.first ? step : 0u;
    for (uint i = block.first; i < block.last; ++i) {
        while (starts.at[sheet + 1u] <= i) ++sheet;
        uint number = order.at[i];
        uvec4 tiles = tiles_of(number);
        uint across = tiles.z - tiles.x, count = across * (tiles.w - tiles.y);
        for (uint k = 0u; k < count; ++k) {
            uint x = tiles.x + k % across, y = tiles.y + k / across;
            uint tile = y * uint(params.frame.tiles.x) + x;
            if (!is_closed(x, y)) entries.at[counters.at[tile * params.frame.tile_blocks + block.column]++] = uvec2(number, sheet);
        }
    }
}
