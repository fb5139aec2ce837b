// The table layers and rotation that 3_select_footprints selects for a splat; both drawing methods read them. Include
// after shaders/edges/edge_record.glsl and face_form.glsl.
#ifndef EDGESPLAT_SELECTED_FOOTPRINT_GLSL
#define EDGESPLAT_SELECTED_FOOTPRINT_GLSL
#include "shaders/footprints/footprint_layer.glsl"

struct SelectedFootprint {
    FootprintLayer layer;
    vec3 axis;  // index space, unit: the texture's x axis, perpendicular to the view; 0 for a plain kernel
};

const uint INTEGRATED = 1u << 30, PLAIN_LAYER = 1u << 31;  // bits of the first word; `layer.code` contains INTEGRATED, too

// Packs 8 bytes per splat: layers, and the axis in the format of normals. `to_voxel`: vector from the eye; the
// footprint is computed for rays along it. `in_table`: the table contains every face that cuts the kernel. `deepest`: of
// the splat's own material; `depth`: that of the table.
uvec2 select_footprint(Edge e, bool in_table, vec3 to_voxel, float depth, float deepest) {
    bool cut = e.state >= EDGE_LOWER && abs(e.d) < KERNEL_R + deepest;
    vec3 u = to_voxel * inversesqrt(max(dot(to_voxel, to_voxel), 1e-12));
    float cosine = dot(e.n, u);
    vec3 across = e.n - cosine * u;
    // Seen along the normal, a footprint is rotationally symmetric.
    float sine2 = dot(across, across);
    vec3 axis = sine2 > 1e-8 ? across * inversesqrt(sine2) : vec3(1.0, 0.0, 0.0);
    uint layer = select_footprint_layer(cut ? e.d : KERNEL_R + depth, cut ? abs(cosine) : 1.0, depth);
    return uvec2(layer | (cut ? (in_table ? 0u : INTEGRATED) : PLAIN_LAYER), pack_normal(axis));
}

SelectedFootprint unpack_footprint(uvec2 code, float depth) {
    SelectedFootprint s;
    s.layer = decode_footprint_layer(code.x & ~PLAIN_LAYER, depth);
    s.axis = (code.x & PLAIN_LAYER) != 0u ? vec3(0.0) : unpack_normal(code.y);
    return s;
}

// Packed into two texels of floats; some of the floats contain integers.
const uint LAYER_AND_NEXT = 2u * TABLE_BLEND_BITS;
vec4 first_texel(SelectedFootprint s) { return vec4(s.axis, float(s.layer.code & (1u << LAYER_AND_NEXT) - 1u)); }
vec4 second_texel(SelectedFootprint s) {
    return vec4(s.layer.middle, s.layer.cosine, s.layer.rim2, float(s.layer.code >> LAYER_AND_NEXT));
}
SelectedFootprint from_texels(vec4 a, vec4 b) {
    return SelectedFootprint(FootprintLayer(uint(a.w) | uint(b.w) << LAYER_AND_NEXT, b.x, b.y, b.z), a.xyz);
}
#endif
