// The share of a light that reaches a splat past its occluders, from 2c_cast_shadows. The including shader declares
// the uniform block `params.frame`.
#ifndef EDGESPLAT_SHADOW_GLSL
#define EDGESPLAT_SHADOW_GLSL

layout(constant_id = SPEC_SHADOWS) const uint SHADOWS = 0u;

// Of the two lights with shadows.
vec2 lights_reach(uint splat) { return SHADOWS == 0u ? vec2(1.0) : unpackUnorm2x16(UintsRef(params.of_volume.splat_shadows).at[splat]); }

// Of a scene's light. `reach`: of the two lights with shadows.
float light_reach(vec2 reach, uint light) {
    if (SHADOWS == 0u) return 1.0;
    uint channel = params.frame.shadow_channels >> (4u * light) & 15u;
    return channel == 0u ? 1.0 : channel == 1u ? reach.x : reach.y;
}
#endif
