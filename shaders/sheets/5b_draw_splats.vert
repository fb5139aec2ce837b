// One quad per splat, 64 per instance: its corners, its layer in the sheet group, its colour. docs/method.md, pass 5.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_ARB_shader_viewport_layer_array : require
#include "shaders/shared/bindings.h"
#include "shaders/shared/frame_params.h"

layout(constant_id = SPEC_FOOTPRINTS) const uint FOOTPRINTS = 2u;
layout(constant_id = SPEC_WARP) const uint WARP = FACE;
layout(constant_id = SPEC_NARROW) const uint NARROW = 0u;
layout(constant_id = SPEC_CREASES) const uint CREASES = 1u;
layout(constant_id = SPEC_TRACED) const uint TRACED = 1u;
layout(constant_id = SPEC_PAYLOAD) const uint PAYLOAD = 0u;
layout(constant_id = SPEC_SLICED) const uint SLICED = 0u;
layout(constant_id = SPEC_TRANSFER) const uint TRANSFER = 0u;
layout(constant_id = SPEC_LIT_EDGES) const uint LIT_EDGES = 0u;
layout(constant_id = SPEC_CLIP_KEEP) const uint CLIP_KEEP = 0u;
layout(constant_id = SPEC_CLIP_REMOVE) const uint CLIP_REMOVE = 0u;
layout(constant_id = SPEC_ANTIALIAS) const uint ANTIALIAS = 0u;

#include "shaders/common/frame.glsl"
layout(push_constant) uniform Push { uint group; };
#include "shaders/splats/splat_projection.glsl"
#include "shaders/light/shading.glsl"
#include "shaders/common/transfer.glsl"
#include "shaders/splats/splat_inputs.glsl"

layout(location = 0) flat out vec4 start_plane;    // rays_beside()
layout(location = 1) flat out vec3 from_eye;       // voxel centre minus eye, index space
layout(location = 2) flat out vec4 color_sigma;    // payload, extinction per mm
layout(location = 3) flat out vec4 normal_distance;  // n, D
layout(location = 4) flat out vec3 shape;  // negative: the splat is not warped; then depths of the slice (mm from the voxel)
layout(location = 5) flat out vec2 slopes;         // slopes of the voxel's centre; only with antialias
layout(location = 6) flat out vec3 matter;         // unlit colour, for cuts; only with clip planes
layout(location = 7) flat out uvec2 number_material;  // of the splat; only with clip planes or faces
layout(location = 8) flat out vec4 filtered;       // share, weights of distances in pixels and voxels, amplitude; only with antialias
layout(location = 9) flat out vec4 face_slope;     // only with faces: FaceForm in four parts, here the value last
layout(location = 10) flat out vec4 face_diagonal; // depth last
layout(location = 11) flat out vec4 face_mixed;    // thickness last
layout(location = 12) flat out vec2 face_reach2_corner;
layout(location = 13) flat out vec4 first_selected;   // only with a table: SelectedFootprint in two parts
layout(location = 14) flat out vec4 second_selected;
layout(location = 15) flat out vec4 crease;

void main() {
    SheetGroup sheets = GroupsRef(params.frame.groups).at[group];
    uint nth = uint(gl_InstanceIndex) * QUADS_PER_INSTANCE + uint(gl_VertexIndex) / 4u;
    bool real = nth < sheets.count;
    uint number = UintsRef(params.frame.order).at[sheets.first + min(nth, sheets.count - 1u)];
    Splat splat = SplatsRef(params.of_volume.splats).at[number];
    Edge e = unpack_edge(splat.normal, splat.edge);
    Projection p = place_splat(number, splat, e);
    uint layer = 0u;
    vec2 depths = vec2(0.0);
    if (SLICED == 1u) {
        // The sort has left each sheet's end in its last counter.
        uint nth_in_all = sheets.first + min(nth, sheets.count - 1u);
        uint first_sheet = group * params.frame.sheets_per_group;
        for (uint s = 0u; s + 1u < params.frame.sheets_per_group; ++s) {
            uint sheet = min(first_sheet + s, params.frame.sheet_count - 1u);
            layer += nth_in_all >= UintsRef(params.frame.counters).at[sheet * SORT_BLOCKS + SORT_BLOCKS - 1u] ? 1u : 0u;
        }
        float near = params.of_volume.sheet_zero + float(first_sheet + layer) * params.frame.sheet_thickness -
                     dot(params.of_volume.view_z, p.position);
        depths = vec2(near, near + params.frame.sheet_thickness);
        cut_support(p, depths);
    } else {
        layer = UintsRef(params.frame.sheets).at[number] - group * params.frame.sheets_per_group;
    }
    project_support(p);

    vec2 corner = vec2(gl_VertexIndex & 1, gl_VertexIndex >> 1 & 1);
    vec2 slope = mix(p.low, p.high, corner);
    from_eye = p.position - params.of_volume.eye;
    start_plane = rays_beside(p, p.at_eye);

    SplatInputs s = splat_inputs(number, splat, e, p, depths);
    color_sigma = s.color_sigma;
    normal_distance = s.normal_distance;
    shape = s.shape;
    if (FACES) {
        face_slope = vec4(s.face.slope, s.face.value);
        face_diagonal = vec4(s.face.h.diagonal, s.face.cut.depth);
        face_mixed = vec4(s.face.h.mixed, s.face.cut.thickness);
        face_reach2_corner = vec2(s.face.cut.reach2, s.face.corner);
        if (CREASES == 1u) crease = vec4(s.face.crease.n, s.face.crease.away);
    }
    if (FOOTPRINTS == TABLE) {
        first_selected = first_texel(s.selected);
        second_selected = second_texel(s.selected);
    }
    if (CLIP_KEEP + CLIP_REMOVE > 0u) matter = s.matter;
    if (CLIP_KEEP + CLIP_REMOVE > 0u || FACES) number_material = s.number_material;
    if (ANTIALIAS == 1u) {
        slopes = p.view.xy / p.view.z;
        filtered = s.filtered;
    }

    vec2 ndc = (p.slope + slope) / vec2(params.frame.tan_half_x, params.frame.tan_half_y);
    gl_Position = real ? vec4(ndc, 0.5, 1.0) : vec4(2.0, 2.0, 0.5, 1.0);
    gl_Layer = int(layer);
}
