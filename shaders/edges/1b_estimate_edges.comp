// For every voxel that can be visible: distance and direction to the nearest edge of its own material interval.
// docs/method.md, pass 1; paper, section 3 (Taylor estimate).
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/shared/bindings.h"
#include "shaders/edges/edge_record.glsl"

layout(local_size_x = 64) in;
#include "shaders/common/groups.glsl"
layout(constant_id = SPEC_ESTIMATOR) const uint ESTIMATOR = 3u;
layout(constant_id = SPEC_BURIED) const uint BURIED = 1u;
layout(constant_id = SPEC_SURFACES) const uint SURFACES = 0u;
const bool SURFELS = ESTIMATOR == MARCH || ESTIMATOR == CUBIC;

layout(binding = BIND_VOLUME, r32f) uniform readonly image3D volume;
layout(binding = BIND_COEFFICIENTS, r32f) uniform readonly image3D coefficients;
layout(binding = BIND_EDGES, rg32ui) uniform writeonly uimage3D edges;
layout(binding = BIND_BURIED, r8ui) uniform readonly uimage3D buried;
layout(binding = BIND_SCENE, scalar) uniform Scene { SceneParams scene; } params;

ivec3 dims;
#include "shaders/common/material.glsl"
#include "shaders/common/volume_sampling.glsl"

// Mean slope over the unit sphere by the 14-point Lebedev rule. Differences along the three axes alone flatten a
// blurred edge by a different amount per axis, and turn its normal by up to 5 degrees.
vec3 field_gradient(ivec3 origin, vec3 p) {
    vec3 last = vec3(dims - 1), from = vec3(origin);
    vec3 centre = clamp(p, min(vec3(1.0), 0.5 * last) - from, max(last - 1.0, 0.5 * last) - from);
    vec3 g = vec3(0.0);
    for (int i = 0; i < 7; ++i) {
        vec3 axis = vec3(i == 0 ? 1.0 : 0.0, i == 1 ? 1.0 : 0.0, i == 2 ? 1.0 : 0.0);
        vec3 diagonal = vec3((i & 1) != 0 ? -1.0 : 1.0, (i & 2) != 0 ? -1.0 : 1.0, 1.0) * 0.57735027;
        vec3 e = i < 3 ? axis : diagonal;
        g += (i < 3 ? 0.2 : 0.225) * (trilinear(origin, centre + e) - trilinear(origin, centre - e)) * e;
    }
    return g;
}

// (gradient, value) at voxel `origin` + p.
vec4 field_slope(ivec3 origin, vec3 p) {
    if (ESTIMATOR == CUBIC) return bspline_slope(origin, p);
    return vec4(field_gradient(origin, p), trilinear(origin, p));
}

ivec3 block_origin() { return params.scene.block_origin; }
ivec3 volume_dims() { return params.scene.volume_dims; }
#include "shaders/drivers/if_any.glsl"
#include "engine/geometry/values_around.glsl"
#include "engine/geometry/find_edge.glsl"

bool matter_ends;  // whether matter may end in the brick

bool is_outermost(ivec3 p) {
    ivec3 at = p + params.scene.block_origin;
    return any(equal(at, ivec3(0))) || any(equal(at, params.scene.volume_dims - 1));
}

// Whether samples around a voxel are of other materials than its own, or missing.
bool ends_around(float value, vec2 around) {
    uint material = material_of(value);
    return material_of(around.x) != material || material_of(around.y) != material || (has_data(value) && !has_data(around.x));
}

void store_edge(ivec3 p, Edge e, uint flags) {
    uvec2 code = e.state == EDGE_NONE ? uvec2(0u) : uvec2(pack_normal(e.n), pack_edge(e) & ~BESIDE_BITS);
    imageStore(edges, p, uvec4(code.x, code.y | flags, 0u, 0u));
}

// Whether an edge is searched at voxel p; else stores what is known without. Invisible voxels have no edge. Only surfels
// end at other voxels; surface splats need no normals of voxels without.
bool wanted(ivec3 p) {
    float value = voxel(p);
    bool visible = in_mask(params.scene.estimate_mask, material_of(value));
    if (BURIED == 1u) visible = visible && imageLoad(buried, p).r == 0u;
    bool searched = visible;
    if (SURFELS) {
        searched = visible && is_outermost(p);
        IF_ANY(matter_ends && visible) searched = searched || ends_around(value, values_around(p));
    }
    IF_ANY(!searched) {
        Edge e = no_edge();
        IF_ANY(SURFACES == 0u && visible) e = normal_only(voxel_gradient(p));
        store_edge(p, e, 0u);
    }
    return searched;
}
#include "shaders/edges/brick_list.glsl"

void main() {
    dims = params.scene.dims;
    ivec3 first = max(params.scene.core_low - ESTIMATE_MARGIN, ivec3(0));
    ivec3 end = min(params.scene.core_low + params.scene.core_size + ESTIMATE_MARGIN, dims);
    uvec3 bricks = uvec3(end - first + BRICK_SIDE - 1) / BRICK;
    uint number = group_number();
    matter_ends = true;
    if (params.scene.brick_count > 0u) {
        if (number >= params.scene.brick_count) return;
        uint entry = UintsRef(params.scene.bricks).at[number];
        matter_ends = (entry & BRICK_ENDS) != 0u;
        number = entry & ~BRICK_ENDS;
    }
    if (number >= bricks.x * bricks.y * bricks.z) return;
    first += BRICK_SIDE * ivec3(number % bricks.x, number / bricks.x % bricks.y, number / bricks.x / bricks.y);
    uint count = list_brick(first, end);
    for (uint i = gl_LocalInvocationIndex; i < count; i += 64u) {
        ivec3 p = first + brick_voxel(brick_voxels[i]);
        float value = voxel(p);
        uint material = material_of(value);
        float low = material == 0u ? -3e38 : params.scene.iso[material - 1u];
        float high = params.scene.iso[material];
        Edge e = no_edge();
        if (ESTIMATOR == TAYLOR) e = extrapolated_edge(value, voxel_gradient(p), low, high, params.scene.band);
        uint flags = 0u;
        if (SURFELS || params.scene.translucent_mask != 0u) {
            vec2 around = values_around(p);
            uint lowest = material_of(around.x);
            // Matter of a missing sample's own material is not there.
            bool missing = has_data(value) && !has_data(around.x);
            IF_ANY(missing) lowest = missing ? min(lowest + 1u, material_of(least_data_around(p))) : lowest;
            flags = pack_beside(Beside(material - lowest, material_of(around.y) - material));
            if (SURFELS) e = find_surfel(p, value, low, high, around);
        }
        IF_ANY(e.state == EDGE_NONE) e = normal_only(voxel_gradient(p));
        if (SURFELS) {
            vec3 out_of = border_beside(p);
            bool cut = is_cut_by_border(e, out_of);
            if (cut) e = border_edge(out_of);
            flags |= cut ? EDGE_BORDER : 0u;
        }
        store_edge(p, e, flags);
    }
}
