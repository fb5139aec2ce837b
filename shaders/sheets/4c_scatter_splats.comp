// Counting sort, last third: every splat number goes to its place; inside a sheet the order of the records stays.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/shared/bindings.h"
#include "shaders/shared/frame_params.h"

layout(local_size_x = 64) in;
layout(constant_id = SPEC_SLICED) const uint SLICED = 0u;
layout(constant_id = SPEC_CULLED) const uint CULLED = 0u;
layout(binding = BIND_FRAME, scalar) uniform Frame { FrameParams frame; } params;
layout(push_constant) uniform Push { uint segment; };  // of each block: one after another

void main() {
    uint block = gl_GlobalInvocationID.x;
    uint per_block = (params.frame.slot_count + SORT_BLOCKS - 1u) / SORT_BLOCKS;
    uint end = min((block + 1u) * per_block, params.frame.slot_count);
    uint first = block * per_block + segment * params.frame.sort_segment, last = min(first + params.frame.sort_segment, end);
    UintsRef sheets = UintsRef(params.frame.sheets), counters = UintsRef(params.frame.counters);
    UintsRef order = UintsRef(params.frame.order);
    for (uint slot = first; slot < last; ++slot) {
        uint sheet = sheets.at[slot], i = slot;
        if (CULLED == 1u) i = PairsRef(params.frame.batches).at[slot / SPLAT_BATCH].x + slot % SPLAT_BATCH;
        if (SLICED == 1u) {
            uint first = sheet & ((1u << SHEET_BITS) - 1u);
            uint end = sheet != SHEET_NONE ? first + (sheet >> SHEET_BITS) + 1u : 0u;
            for (sheet = first; sheet < end; ++sheet) order.at[counters.at[sheet * SORT_BLOCKS + block]++] = i;
        } else {
            if (sheet != SHEET_NONE) order.at[counters.at[sheet * SORT_BLOCKS + block]++] = i;
        }
    }
}
