// Prefix sums over the invocations of a workgroup. The including shader declares the workgroup size, along x only.
#ifndef EDGESPLAT_WORKGROUP_SUMS_GLSL
#define EDGESPLAT_WORKGROUP_SUMS_GLSL
const uint SUMS = gl_WorkGroupSize.x;
shared uint sums[SUMS];

// Exclusive prefix sum of `own`; sums[i] contains the inclusive sum. All invocations must call it.
uint sum_before(uint own) {
    uint me = gl_LocalInvocationIndex;
    sums[me] = own;
    barrier();
    for (uint step = 1u; step < SUMS; step *= 2u) {
        uint left = me >= step ? sums[me - step] : 0u;
        barrier();
        sums[me] += left;
        barrier();
    }
    return sums[me] - own;
}
#endif
