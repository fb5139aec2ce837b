// Counting sort, step 2 of 3: exclusive prefix sum over (sheet, block). Then the beginning of each sheet, or the range
// and draw call of each sheet group. One workgroup: each invocation sums a run of counters; the runs are scanned in
// shared memory.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/shared/bindings.h"
#include "shaders/shared/frame_params.h"

layout(local_size_x = 256) in;
#include "shaders/common/frame.glsl"
layout(constant_id = SPEC_TILES) const uint TILES = 1u;
#include "shaders/common/row_sums.glsl"

void main() {
    UintsRef counters = UintsRef(params.frame.counters);
    uint me = gl_LocalInvocationIndex, total = sum_row(counters, 0u, params.frame.sheet_count * SORT_BLOCKS);
    memoryBarrierBuffer();
    barrier();

    if (TILES == 1u) {
        UintsRef starts = UintsRef(params.frame.sheet_starts);
        for (uint s = me; s < params.frame.sheet_count; s += 256u) starts.at[s] = counters.at[s * SORT_BLOCKS];
        if (me == 0u) starts.at[params.frame.sheet_count] = total;
    } else {
        GroupsRef groups = GroupsRef(params.frame.groups);
        DrawsRef draws = DrawsRef(params.frame.draws);
        for (uint g = me; g < params.frame.group_count; g += 256u) {
            uint begin_sheet = g * params.frame.sheets_per_group, end_sheet = begin_sheet + params.frame.sheets_per_group;
            uint begin = counters.at[begin_sheet * SORT_BLOCKS];
            uint end = end_sheet >= params.frame.sheet_count ? total : counters.at[end_sheet * SORT_BLOCKS];
            groups.at[g].first = begin;
            groups.at[g].count = end - begin;
            draws.at[g] = DrawCommand(QUADS_PER_INSTANCE * 6u, (end - begin + QUADS_PER_INSTANCE - 1u) / QUADS_PER_INSTANCE,
                                      0u, 0, 0u);
        }
    }
    if (me == 0u) UintsRef(params.frame.drawn).at[0] = total;
}
