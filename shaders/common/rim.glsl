// How kernels of one volume give way to those of another along the rim of its grid. docs/method/surfaces.md, Several
// volumes. Include after shaders/common/frame.glsl.
#ifndef EDGESPLAT_RIM_GLSL
#define EDGESPLAT_RIM_GLSL

layout(constant_id = SPEC_RIM) const uint RIM = 0u;

// From 0 to 1 with two continuous derivatives.
float risen(float t) {
    t = clamp(t, 0.0, 1.0);
    return t * t * t * (10.0 + t * (6.0 * t - 15.0));
}

// Share of the kernel of a voxel, relative to the anchor, that is drawn.
float rim_share(vec3 position) {
    float inside = 1.0;
    for (int i = 0; i < 6; ++i) inside *= risen(dot(params.of_volume.rim[i], vec4(position, 1.0)));
    return params.of_volume.rim_within == 1u ? inside : 1.0 - inside;
}
#endif
