// Parallel counting sort, step 1: counts the splats of each block in each sheet. Each slot adds itself; the order of
// additions does not change the counts.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/shared/bindings.h"
#include "shaders/shared/frame_params.h"

layout(local_size_x = 64) in;
#include "shaders/common/groups.glsl"
layout(constant_id = SPEC_SLICED) const uint SLICED = 0u;
#include "shaders/common/frame.glsl"
#include "shaders/sheets/sheets_of_slot.glsl"

void main() {
    uint slot = invocation_number();
    if (slot >= params.frame.slot_count) return;
    uvec2 sheets = sheets_of_slot(slot);
    uint block = slot / slots_per_block();
    for (uint sheet = sheets.x; sheet < sheets.y; ++sheet)
        atomicAdd(UintsRef(params.frame.counters).at[sheet * SORT_BLOCKS + block], 1u);
}
