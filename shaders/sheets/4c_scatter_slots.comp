// Parallel counting sort, last step: writes every splat number to its position. A workgroup processes a block, as many
// slots together as it has invocations. Each invocation counts the slots before it with the same sheet, so that the
// order of the records is kept.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/shared/bindings.h"
#include "shaders/shared/frame_params.h"

layout(local_size_x = 256) in;
layout(constant_id = SPEC_SLICED) const uint SLICED = 0u;
layout(constant_id = SPEC_CULLED) const uint CULLED = 0u;
#include "shaders/common/frame.glsl"
#include "shaders/sheets/sheets_of_slot.glsl"

shared uvec2 together[256];  // sheets of the slots that are processed together

void main() {
    uint block = gl_WorkGroupID.x, me = gl_LocalInvocationIndex;
    uvec2 slots = slots_of_block(block);
    CountersRef counters = CountersRef(params.frame.counters);
    UintsRef starts = UintsRef(params.frame.sheet_starts), order = UintsRef(params.frame.order);
    for (uint base = slots.x; base < slots.y; base += 256u) {
        uint slot = base + me, number = slot;
        uvec2 own = slot < slots.y ? sheets_of_slot(slot) : uvec2(0u);
        together[me] = own;
        barrier();
        if (CULLED == 1u && slot < slots.y)
            number = PairsRef(params.frame.batches).at[slot / SPLAT_BATCH].x + slot % SPLAT_BATCH;
        for (uint sheet = own.x; sheet < own.y; ++sheet) {
            uint before = 0u;
            for (uint i = 0u; i < me; ++i) before += together[i].x <= sheet && sheet < together[i].y ? 1u : 0u;
            order.at[starts.at[sheet] + counters.at[sheet * SORT_BLOCKS + block] + before] = number;
        }
        memoryBarrierBuffer();
        barrier();
        for (uint sheet = own.x; sheet < own.y; ++sheet) atomicAdd(counters.at[sheet * SORT_BLOCKS + block], 1u);
        memoryBarrierBuffer();
        barrier();
    }
}
