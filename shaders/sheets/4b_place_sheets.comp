// Parallel counting sort, step 3: finds the beginning of each sheet. One workgroup.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/shared/bindings.h"
#include "shaders/shared/frame_params.h"

layout(local_size_x = 256) in;
#include "shaders/common/frame.glsl"
#include "shaders/common/row_sums.glsl"

void main() {
    UintsRef starts = UintsRef(params.frame.sheet_starts);
    uint count = params.frame.sheet_count, sum = sum_row(starts, 0u, count);
    if (gl_LocalInvocationIndex == 0u) {
        starts.at[count] = sum;
        UintsRef(params.frame.drawn).at[0] = sum;
    }
}
