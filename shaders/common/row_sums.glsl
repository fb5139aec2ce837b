// Exclusive prefix sum of one histogram row, computed by a workgroup.
#include "shaders/common/workgroup_sums.glsl"

// Replaces each counter in [first, first + count) by the sum of the counters before it; returns the total.
uint sum_row(UintsRef counters, uint first, uint count) {
    uint me = gl_LocalInvocationIndex, per_run = (count + SUMS - 1u) / SUMS;
    uint begin = first + min(me * per_run, count), end = first + min((me + 1u) * per_run, count);
    uint sum = 0u;
    for (uint i = begin; i < end; ++i) sum += counters.at[i];
    uint offset = sum_before(sum);
    for (uint i = begin; i < end; ++i) {
        uint n = counters.at[i];
        counters.at[i] = offset;
        offset += n;
    }
    return sums[SUMS - 1u];
}
