// Compacts the voxels that can be seen into splat records, in the order of the voxels. Each invocation owns a run of
// consecutive voxels; the first dispatch counts, the second writes where the host's prefix sum of the counts says.
// Afterwards run_offsets holds how many of each run's splats have an edge.
// On the way edge distances are smoothed along the surface (pass 1, step 5): here only voxels that are seen pay for it.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/shared/bindings.h"
#include "shaders/shared/scene_params.h"

layout(local_size_x = 64) in;
layout(constant_id = SPEC_EDGES) const uint EDGES = 1u;
layout(constant_id = SPEC_BURIED) const uint BURIED = 1u;
layout(constant_id = SPEC_SMOOTH) const uint SMOOTH = 1u;
layout(constant_id = SPEC_CURVED) const uint CURVED = 0u;
layout(constant_id = SPEC_WEIGHTED) const uint WEIGHTED = 0u;
layout(constant_id = SPEC_CLIP_KEEP) const uint CLIP_KEEP = 0u;
layout(constant_id = SPEC_CLIP_REMOVE) const uint CLIP_REMOVE = 0u;
layout(constant_id = SPEC_TRANSFER) const uint TRANSFER = 0u;
layout(binding = BIND_VOLUME, r32f) uniform readonly image3D volume;
layout(binding = BIND_EDGES, rg32ui) uniform readonly uimage3D edges;
layout(binding = BIND_BURIED, r8ui) uniform readonly uimage3D buried;
layout(binding = BIND_SCENE, scalar) uniform Scene { SceneParams scene; } params;
layout(push_constant) uniform Push { uint write; };

ivec3 dims;
#include "shaders/lib/material.glsl"
#define CLIP_PARAMS params.scene
#include "shaders/lib/clip.glsl"
#include "shaders/lib/trilinear.glsl"
#include "shaders/lib/transfer.glsl"

uint material_at(ivec3 p) { return material_of(voxel(p)); }
#include "shaders/lib/edge_smoothing.glsl"
#include "shaders/lib/kernel_weight.glsl"
#include "shaders/lib/classified_value.glsl"
#include "shaders/lib/edge_weight.glsl"

// With the other side of the edge, a voxel beyond it.
float contrast_of(ivec3 p, float value, uint material, Edge e) {
    if (TRANSFER == 1u && e.state >= EDGE_LOWER) {
        float beyond = trilinear(vec3(p) + (1.0 + max(e.d, 0.0)) * e.n);
        TransferRef transfer = TransferRef(params.scene.transfer);
        return clamp(1.0 - transfer_at(transfer, beyond).a / transfer_at(transfer, value).a, 0.0, 1.0);
    }
    vec2 contrast = params.scene.contrast[material];
    return e.state == EDGE_UPPER ? contrast.y : contrast.x;
}

void main() {
    dims = params.scene.dims;
    ivec3 size = params.scene.core_size, end = params.scene.core_low + size;
    uint voxels = uint(size.x) * uint(size.y) * uint(size.z);
    uint run = gl_GlobalInvocationID.x + gl_GlobalInvocationID.y * gl_NumWorkGroups.x * gl_WorkGroupSize.x;
    uint first = run * COLLECT_RUN;
    if (run >= (voxels + COLLECT_RUN - 1u) / COLLECT_RUN) return;
    uint last = min(first + COLLECT_RUN, voxels);
    UintsRef offsets = UintsRef(params.scene.run_offsets);
    SplatsRef splats = SplatsRef(params.scene.splats);

    ivec3 p = params.scene.core_low +
              ivec3(first % uint(size.x), first / uint(size.x) % uint(size.y), first / uint(size.x) / uint(size.y));
    uint out_at = write == 1u ? offsets.at[run] : 0u;
    uint with_edge = 0u;
    for (uint v = first; v < last; ++v) {
        uint material = material_at(p);
        bool visible = in_mask(params.scene.visible_mask, material);
        if (BURIED == 1u) visible = visible && imageLoad(buried, p).r == 0u;
        // No kernel reaches further than R + a.
        if (CLIP_KEEP + CLIP_REMOVE > 0u) visible = visible && !is_cut_away(vec3(p), params.scene.band);
        float value = 0.0;
        if (TRANSFER == 1u) {
            uvec2 code = EDGES == 1u && visible ? imageLoad(edges, p).xy : uvec2(0u);
            value = classified_value(p, voxel(p), material, unpack_edge(code.x, code.y));
            visible = visible && transfer_at(TransferRef(params.scene.transfer), value).a > 0.0;
        }
        if (visible) {
            if (write == 1u) {
                if (TRANSFER == 1u) ClassifiedRef(params.scene.values).at[out_at] = value;
                uvec2 code = EDGES == 1u ? imageLoad(edges, p).xy : uvec2(0u);
                Edge e = unpack_edge(code.x, code.y);
                if (WEIGHTED == WEIGHTED_VOXEL)
                    UintsRef(params.scene.traits).at[out_at] =
                        pack_traits(0.0, kernel_weight(p, dims, e), params.scene.curvature_unit);
                float contrast = WEIGHTED == WEIGHTED_EDGE ? contrast_of(p, value, material, e) : 0.0, curvature = 0.0;
                if (SMOOTH == 1u || CURVED == 1u) {
                    SurfaceAround around = surface_around(p, dims, e, material);
                    if (SMOOTH == 1u) {
                        e.d += around.distance_correction;
                        e.d2 -= around.distance_correction;
                    }
                    if (CURVED == 1u) {
                        // The centre must not lie between the voxel and its edge.
                        float most = 0.95 / max(abs(e.d), 0.1);
                        curvature = clamp(around.curvature, -most, most);
                    }
                }
                if (e.state >= EDGE_LOWER && abs(e.d) > params.scene.band) e = Edge(e.n, 1e9, 1e9, EDGE_NORMAL);
                if (CURVED == 1u || WEIGHTED == WEIGHTED_EDGE)
                    UintsRef(params.scene.traits).at[out_at] = pack_traits(
                        curvature, WEIGHTED == WEIGHTED_EDGE ? edge_weight(e, contrast) : 1.0, params.scene.curvature_unit);
                with_edge += e.state >= EDGE_LOWER ? 1u : 0u;
                uvec3 at = uvec3(p + params.scene.block_origin), whole = uvec3(params.scene.volume_dims);
                splats.at[out_at] = Splat(at.x + whole.x * (at.y + whole.y * at.z), code.x, pack_edge(e) | (material << 28));
            }
            ++out_at;
        }
        if (++p.x == end.x) {
            p.x = params.scene.core_low.x;
            if (++p.y == end.y) {
                p.y = params.scene.core_low.y;
                ++p.z;
            }
        }
    }
    offsets.at[run] = write == 1u ? with_edge : out_at;
}
