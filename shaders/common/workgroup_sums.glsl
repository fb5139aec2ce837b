// What the invocations of a workgroup have before one another. The including shader declares the workgroup's size, along x.
#ifndef EDGESPLAT_WORKGROUP_SUMS_GLSL
#define EDGESPLAT_WORKGROUP_SUMS_GLSL
const uint SUMS = gl_WorkGroupSize.x;
shared uint sums[SUMS];

// The sum over the invocations before this one; sums[i] is that of the invocations up to i. Called by all of them.
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
