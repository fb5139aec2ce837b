// Compacts the voxels that can be seen into splat records, in the order of the voxels. Each invocation owns a run of
// consecutive voxels; the first dispatch counts, the second writes where the host's prefix sum of the counts says.
// 2a_finish_splats gives them their edges.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/shared/bindings.h"
#include "shaders/lib/edge_record.glsl"

layout(local_size_x = 64) in;
layout(constant_id = SPEC_EDGES) const uint EDGES = 1u;
layout(constant_id = SPEC_BURIED) const uint BURIED = 1u;
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
#include "shaders/lib/classified_value.glsl"

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
                uvec3 at = uvec3(p + params.scene.block_origin), whole = uvec3(params.scene.volume_dims);
                splats.at[out_at] = Splat(at.x + whole.x * (at.y + whole.y * at.z), 0u, material << 28);
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
    if (write == 0u) offsets.at[run] = out_at;
}
