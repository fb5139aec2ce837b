// What the 256 invocations of a workgroup have before one another. The including shader declares that size.
#ifndef EDGESPLAT_WORKGROUP_SUMS_GLSL
#define EDGESPLAT_WORKGROUP_SUMS_GLSL
shared uint sums[256];

// The sum over the invocations before this one; sums[255] is that of all. Called by all of them.
uint sum_before(uint own) {
    uint me = gl_LocalInvocationIndex;
    sums[me] = own;
    barrier();
    for (uint step = 1u; step < 256u; step *= 2u) {
        uint left = me >= step ? sums[me - step] : 0u;
        barrier();
        sums[me] += left;
        barrier();
    }
    return sums[me] - own;
}
#endif
