// The share of a light that reaches a splat past its occluders, from 2d_shadow_splats. The including shader declares
// the uniform block `params.frame`.
#ifndef EDGESPLAT_SHADOW_GLSL
#define EDGESPLAT_SHADOW_GLSL

layout(constant_id = SPEC_SHADOWS) const uint SHADOWS = 0u;

float light_reach(uint splat, uint light) {
    if (SHADOWS == 0u) return 1.0;
    uint channel = params.frame.shadow_channels >> (4u * light) & 15u;
    vec2 reach = unpackUnorm2x16(UintsRef(params.frame.splat_shadows).at[splat]);
    return channel == 0u ? 1.0 : channel == 1u ? reach.x : reach.y;
}
#endif
