// Parallel counting sort, step 2: prefix sums over the blocks of a sheet, and the sheet's total. One workgroup per
// sheet.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/shared/bindings.h"
#include "shaders/shared/frame_params.h"

layout(local_size_x = 256) in;
#include "shaders/common/groups.glsl"
#include "shaders/common/frame.glsl"
#include "shaders/common/row_sums.glsl"

void main() {
    uint sheet = group_number();
    if (sheet >= params.frame.sheet_count) return;
    uint sum = sum_row(UintsRef(params.frame.counters), sheet * SORT_BLOCKS, SORT_BLOCKS);
    if (gl_LocalInvocationIndex == 0u) UintsRef(params.frame.sheet_starts).at[sheet] = sum;
}
