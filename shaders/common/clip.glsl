// Tests against clip planes: docs/method.md, "Clip". The including shader declares the specialization constants
// CLIP_KEEP and CLIP_REMOVE (numbers of planes; 0 compiles to nothing) and CLIP_PARAMS, which contains the planes.
#ifndef EDGESPLAT_CLIP_GLSL
#define EDGESPLAT_CLIP_GLSL

// Normal and offset of a plane of the kept and of the removed region.
vec4 keep_plane(uint i) { return CLIP_PARAMS.clip_keep[i]; }
vec4 remove_plane(uint i) { return CLIP_PARAMS.clip_remove[i]; }

// Whether a whole sphere is cut away.
bool is_cut_away(vec3 centre, float radius) {
    bool beyond = false, within = CLIP_REMOVE > 0u;
    for (uint i = 0u; i < CLIP_KEEP; ++i) beyond = beyond || dot(keep_plane(i), vec4(centre, 1.0)) > radius;
    for (uint i = 0u; i < CLIP_REMOVE; ++i) within = within && dot(remove_plane(i), vec4(centre, 1.0)) < -radius;
    return beyond || within;
}
#endif
