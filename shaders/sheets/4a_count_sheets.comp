// Counting sort, step 1 of 3: counts the splats of each block in each sheet. One invocation owns one block of
// consecutive slots and one column of the histogram, so there is no race and the sort is stable.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/shared/bindings.h"
#include "shaders/shared/frame_params.h"

layout(local_size_x = 64) in;
layout(constant_id = SPEC_SLICED) const uint SLICED = 0u;
#include "shaders/common/frame.glsl"
layout(push_constant) uniform Push { uint segment; };  // segments of each block are processed one after another
#include "shaders/sheets/sheets_of_slot.glsl"

void main() {
    uint block = gl_GlobalInvocationID.x;
    uvec2 slots = slots_of_block(block);
    uint first = slots.x + segment * params.frame.sort_segment, last = min(first + params.frame.sort_segment, slots.y);
    UintsRef counters = UintsRef(params.frame.counters);
    for (uint slot = first; slot < last; ++slot) {
        uvec2 sheets = sheets_of_slot(slot);
        for (uint sheet = sheets.x; sheet < sheets.y; ++sheet) ++counters.at[sheet * SORT_BLOCKS + block];
    }
}
