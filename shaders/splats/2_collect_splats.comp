// Compacts voxels into splat records, brick by brick (engine/culling/brick_runs.h): visible voxels, and voxels beside
// translucent matter. Each invocation owns one slice of a brick. The first dispatch counts; the second writes at the
// positions from the host's prefix sum of the counts. 2a_finish_splats adds the edges.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/shared/bindings.h"
#include "shaders/edges/edge_record.glsl"

layout(local_size_x = 64) in;
#include "shaders/common/groups.glsl"
layout(constant_id = SPEC_EDGES) const uint EDGES = 1u;
layout(constant_id = SPEC_BURIED) const uint BURIED = 1u;
layout(constant_id = SPEC_CLIP_KEEP) const uint CLIP_KEEP = 0u;
layout(constant_id = SPEC_CLIP_REMOVE) const uint CLIP_REMOVE = 0u;
layout(constant_id = SPEC_TRANSFER) const uint TRANSFER = 0u;
layout(constant_id = SPEC_SURFACES) const uint SURFACES = 0u;
layout(binding = BIND_VOLUME, r32f) uniform readonly image3D volume;
layout(binding = BIND_EDGES, rg32ui) uniform readonly uimage3D edges;
layout(binding = BIND_BURIED, r8ui) uniform readonly uimage3D buried;
layout(binding = BIND_SCENE, scalar) uniform Scene { SceneParams scene; } params;
layout(push_constant) uniform Push { uint write; };

ivec3 dims;
#include "shaders/common/material.glsl"
#define CLIP_PARAMS params.scene
#include "shaders/common/clip.glsl"
#include "shaders/common/trilinear.glsl"
#include "shaders/common/transfer.glsl"
#include "shaders/common/labels.glsl"

uint material_at(ivec3 p) { return material_of(voxel(p)); }
#include "shaders/drivers/if_any.glsl"
#include "engine/geometry/values_around.glsl"
#include "engine/geometry/classified_value.glsl"
#include "engine/geometry/ends_beside.glsl"

void main() {
    dims = params.scene.dims;
    // Adjacent invocations own adjacent bricks of one slice, so that their voxels are close in memory.
    ivec3 size = params.scene.core_size;
    uvec3 runs = uvec3(uvec2(size.xy) + BRICK - 1u, uint(size.z)) / uvec3(BRICK, BRICK, 1u);
    uint run = invocation_number();
    if (params.scene.brick_count > 0u) {
        uint slice = run / params.scene.brick_count;
        if (slice >= BRICK) return;
        uint brick = UintsRef(params.scene.bricks).at[run % params.scene.brick_count] & ~BRICK_ENDS, layer = runs.x * runs.y;
        run = brick % layer + layer * (brick / layer * BRICK + slice);
    }
    if (run >= runs.x * runs.y * runs.z) return;
    ivec3 low = ivec3(run % runs.x * BRICK, run / runs.x % runs.y * BRICK, run / runs.x / runs.y);
    ivec2 extent = min(size.xy - low.xy, ivec2(BRICK));
    low += params.scene.core_low;
    UintsRef offsets = UintsRef(params.scene.run_offsets);
    SplatsRef splats = SplatsRef(params.scene.splats);

    ivec3 p = low;
    uint out_at = write == 1u ? offsets.at[run] : 0u;
    for (int v = 0; v < extent.x * extent.y; ++v) {
        float sample_here = voxel(p);
        uint own = material_of(sample_here);
        bool there = true;
        if (BURIED == 1u) there = imageLoad(buried, p).r == 0u;
        if (CLIP_KEEP + CLIP_REMOVE > 0u) there = there && !is_cut_away(vec3(p), params.scene.reach);
        uvec2 code = uvec2(0u);
        IF_ANY(EDGES == 1u && there && (TRANSFER == 1u || params.scene.translucent_mask != 0u)) code = imageLoad(edges, p).xy;
        Beside beside = unpack_beside(code.y);
        if (SURFACES == 1u) there = there && ends_beside(p, sample_here, own);
        for (uint material = 0u; material <= ISO_COUNT; ++material) {
            bool carried = material + beside.below >= own && material <= own + beside.above;
            bool visible = there && (material == own ? has_data(sample_here) && in_mask(params.scene.visible_mask, own)
                                                     : carried && in_mask(params.scene.translucent_mask, material));
            float value = 0.0;
            if (TRANSFER == 1u) {
                Edge e = unpack_edge(code.x, code.y);
                IF_ANY(visible) value = material == own ? classified_value(p, sample_here, own, e) : carried_value(p, own, material, e);
                visible = visible && transfer_at(TransferRef(params.scene.transfer), value).a > 0.0;
            }
            if (visible) {
                if (write == 1u) {
                    if (TRANSFER == 1u) ClassifiedRef(params.scene.values).at[out_at] = value;
                    if (LABELS != 0u && SURFACES == 0u) UintsRef(params.scene.labels).at[out_at] = material == 0u ? 0u : label_near(p);
                    uvec3 at = uvec3(p + params.scene.block_origin), whole = uvec3(params.scene.volume_dims);
                    splats.at[out_at] = Splat(at.x + whole.x * (at.y + whole.y * at.z), 0u, material << 28);
                }
                ++out_at;
            }
        }
        if (++p.x == low.x + extent.x) {
            p.x = low.x;
            ++p.y;
        }
    }
    if (write == 0u) offsets.at[run] = out_at;
}
