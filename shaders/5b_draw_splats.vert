// One quad a splat, 64 an instance: its corners, its layer of the sheet group, its colour. docs/method.md, pass 5.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_ARB_shader_viewport_layer_array : require
#include "shaders/shared/bindings.h"
#include "shaders/shared/frame_params.h"

layout(constant_id = SPEC_FOOTPRINTS) const uint FOOTPRINTS = 3u;
layout(constant_id = SPEC_PAYLOAD) const uint PAYLOAD = 0u;
layout(constant_id = SPEC_SLICED) const uint SLICED = 0u;
layout(constant_id = SPEC_CURVED) const uint CURVED = 0u;
layout(constant_id = SPEC_WEIGHTED) const uint WEIGHTED = 0u;
layout(constant_id = SPEC_TRANSFER) const uint TRANSFER = 0u;
layout(constant_id = SPEC_LIT_EDGES) const uint LIT_EDGES = 0u;
layout(constant_id = SPEC_CLIP_KEEP) const uint CLIP_KEEP = 0u;
layout(constant_id = SPEC_CLIP_REMOVE) const uint CLIP_REMOVE = 0u;
layout(constant_id = SPEC_ANTIALIAS) const uint ANTIALIAS = 0u;

layout(push_constant) uniform Push {
    FrameRef params;
    uint group;
};
#include "shaders/lib/splat_projection.glsl"
#include "shaders/lib/shading.glsl"
#include "shaders/lib/transfer.glsl"

layout(location = 0) out vec3 offset;              // a point of the pixel's ray, relative to the voxel, index space
layout(location = 1) flat out vec3 from_eye;       // voxel centre minus eye, index space
layout(location = 2) flat out vec4 color_sigma;    // payload, extinction per mm
layout(location = 3) flat out vec4 normal_distance;  // n, D
layout(location = 4) flat out vec4 shape;  // D2 (negative: the splat is not warped), curvature, depths of the slice (mm from the voxel)
layout(location = 5) out vec2 pixels;              // from the voxel's centre to the fragment's; with antialias only
layout(location = 6) flat out vec3 matter;         // colour before light: what a cut shows; with clip planes only
layout(location = 7) flat out uvec2 number_material;  // of the splat, likewise
layout(location = 8) flat out vec4 filtered;       // share, weights of distances in pixels and voxels, amplitude; with antialias only

void main() {
    SheetGroup sheets = GroupsRef(params.frame.groups).at[group];
    uint nth = uint(gl_InstanceIndex) * QUADS_PER_INSTANCE + uint(gl_VertexIndex) / 4u;
    bool real = nth < sheets.count;
    uint number = UintsRef(params.frame.order).at[sheets.first + min(nth, sheets.count - 1u)];
    Splat splat = SplatsRef(params.frame.splats).at[number];
    Edge e = unpack_edge(splat.normal, splat.edge);
    Projection p = place_splat(splat.voxel, e);
    uint layer = 0u;
    vec2 depths = vec2(0.0);
    if (SLICED == 1u) {
        // The sort left each sheet's end in its last counter.
        uint nth_in_all = sheets.first + min(nth, sheets.count - 1u);
        uint first_sheet = group * params.frame.sheets_per_group;
        for (uint s = 0u; s + 1u < params.frame.sheets_per_group; ++s) {
            uint sheet = min(first_sheet + s, params.frame.sheet_count - 1u);
            layer += nth_in_all >= UintsRef(params.frame.counters).at[sheet * SORT_BLOCKS + SORT_BLOCKS - 1u] ? 1u : 0u;
        }
        float near = params.frame.sheet_zero + float(first_sheet + layer) * params.frame.sheet_thickness -
                     dot(params.frame.view_z, p.position);
        depths = vec2(near, near + params.frame.sheet_thickness);
        cut_support(p, depths);
    } else {
        layer = UintsRef(params.frame.sheets).at[number] - group * params.frame.sheets_per_group;
    }
    project_support(p);

    vec2 corner = vec2(gl_VertexIndex & 1, gl_VertexIndex >> 1 & 1);
    vec2 slope = mix(p.low, p.high, corner);
    from_eye = p.position - params.frame.eye;
    // A splat at the eye may lie behind the eye plane: its rays are described where every ray passes.
    offset = p.at_eye
        ? params.frame.near_depth * (params.frame.ray_z + slope.x * params.frame.ray_x + slope.y * params.frame.ray_y) - from_eye
        : p.depth * (slope.x * params.frame.ray_x + slope.y * params.frame.ray_y);
    if (!p.at_eye) offset += p.centre;

    vec4 material = vec4(0.0);
    if (TRANSFER == 1u)
        material = transfer_at(TransferRef(params.frame.transfer), ClassifiedRef(params.frame.values).at[number]);
    else
        material = params.frame.materials[splat.edge >> 28];
    // A surface faces its lower values, whichever side of it the splat is on.
    vec3 outward = e.state == EDGE_UPPER ? -e.n : e.n;
    vec3 world_normal = e.state == EDGE_NONE ? vec3(0.0) : normalize(params.frame.normal_to_world * outward);
    vec3 world_from_eye = params.frame.index_to_world * from_eye;
    vec3 to_eye = -unit_or_zero(world_from_eye);
    // A wall's kernel reaches both faces, and the one that is seen faces the eye.
    bool turned = FOOTPRINTS != 0u && e.state >= EDGE_LOWER && e.d2 < params.frame.band && dot(world_normal, to_eye) < 0.0;
    if (turned) world_normal = -world_normal;
    float depth = SLICED == 1u ? p.view.z + clamp(0.0, depths.x, depths.y) : p.view.z;
    vec3 payload = vec3(0.0);
    if (PAYLOAD == PAYLOAD_COLOR) {
        bool has_normal = e.state >= (LIT_EDGES == 1u ? EDGE_LOWER : EDGE_NORMAL);
        payload = shade(Surface(material.rgb, splat.edge >> 28, number, has_normal, world_normal, turned, world_from_eye, to_eye, depth));
    }
    if (PAYLOAD == PAYLOAD_DEPTH_DISTANCE) {
        float signed_distance = e.state == EDGE_LOWER ? -e.d : e.state == EDGE_UPPER ? e.d : -params.frame.band;
        payload = vec3(depth, signed_distance, 0.0);
    }
    if (PAYLOAD == PAYLOAD_NORMAL) payload = world_normal;
    color_sigma = vec4(payload, material.a);
    if (CLIP_KEEP + CLIP_REMOVE > 0u) {
        matter = material.rgb;
        number_material = uvec2(number, splat.edge >> 28);
    }
    normal_distance = vec4(e.n, e.d);
    bool warped = FOOTPRINTS != 0u && e.state >= EDGE_LOWER && abs(e.d) < params.frame.band;
    vec2 traits = vec2(0.0, 1.0);
    if (CURVED == 1u || WEIGHTED == 1u)
        traits = unpack_traits(UintsRef(params.frame.traits).at[number], params.frame.curvature_unit);
    shape = vec4(warped ? e.d2 : -1.0, CURVED == 1u ? traits.x : 0.0, depths);
    if (WEIGHTED == 1u) color_sigma.a *= traits.y;
    if (ANTIALIAS == 1u) {
        LowPass f = p.filtered;
        pixels = (p.slope + slope - p.view.xy / p.view.z) / params.frame.pixel;
        // Weights belong to the warped kernel.
        float matter = (warped ? matter_of_voxel(e.d, e.d2) : 1.0) / (WEIGHTED == 1u ? traits.y : 1.0);
        filtered = vec4(f.share, f.of_pixels, f.of_voxels, matter * sqrt(f.of_voxels));
        if (f.share >= 1.0) shape.x = -1.0;
    }

    vec2 ndc = (p.slope + slope) / vec2(params.frame.tan_half_x, params.frame.tan_half_y);
    gl_Position = real ? vec4(ndc, 0.5, 1.0) : vec4(2.0, 2.0, 0.5, 1.0);
    gl_Layer = int(layer);
}
