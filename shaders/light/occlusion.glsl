// The share of ambient light that reaches a splat, from 2b_occlude_ambient. The including shader declares the uniform
// block `params.frame`. `turned`: use the other face of a wall.
#ifndef EDGESPLAT_OCCLUSION_GLSL
#define EDGESPLAT_OCCLUSION_GLSL

layout(constant_id = SPEC_OCCLUSION) const uint OCCLUSION = 0u;

float ambient_reach(uint splat, bool turned) {
    if (OCCLUSION == 0u) return 1.0;
    vec2 reach = unpackUnorm2x16(UintsRef(params.of_volume.splat_occlusion).at[splat]);
    return 1.0 - params.frame.occlusion_strength * (1.0 - (turned ? reach.y : reach.x));
}
#endif
