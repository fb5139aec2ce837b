// Counting sort, step 3 of 3: writes every splat number to its position. Inside a sheet the order of the records is
// kept.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/shared/bindings.h"
#include "shaders/shared/frame_params.h"

layout(local_size_x = 64) in;
layout(constant_id = SPEC_SLICED) const uint SLICED = 0u;
layout(constant_id = SPEC_CULLED) const uint CULLED = 0u;
#include "shaders/common/frame.glsl"
layout(push_constant) uniform Push { uint segment; };  // segments of each block are processed one after another
#include "shaders/sheets/sheets_of_slot.glsl"

void main() {
    uint block = gl_GlobalInvocationID.x;
    uvec2 slots = slots_of_block(block);
    uint first = slots.x + segment * params.frame.sort_segment, last = min(first + params.frame.sort_segment, slots.y);
    UintsRef counters = UintsRef(params.frame.counters), order = UintsRef(params.frame.order);
    for (uint slot = first; slot < last; ++slot) {
        uvec2 sheets = sheets_of_slot(slot);
        uint i = slot;
        if (CULLED == 1u) i = PairsRef(params.frame.batches).at[slot / SPLAT_BATCH].x + slot % SPLAT_BATCH;
        for (uint sheet = sheets.x; sheet < sheets.y; ++sheet) order.at[counters.at[sheet * SORT_BLOCKS + block]++] = i;
    }
}
