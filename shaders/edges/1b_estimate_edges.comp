// For every voxel that can be visible: distance and direction to the nearest edge of its own material interval.
// docs/method.md, pass 1; paper, section 3 (Taylor estimate).
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/shared/bindings.h"
#include "shaders/edges/edge_record.glsl"

layout(local_size_x = 64) in;
layout(constant_id = SPEC_ESTIMATOR) const uint ESTIMATOR = 3u;
layout(constant_id = SPEC_BURIED) const uint BURIED = 1u;
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
#include "shaders/edges/find_surfel.glsl"

// One step along the voxel's own gradient (paper; Levoy 1988).
Edge extrapolate(ivec3 p, float value, float low, float high, float band) {
    Edge e = Edge(vec3(0.0, 0.0, 1.0), 1e9, 1e9, EDGE_NONE);
    vec3 g = voxel_gradient(p);
    float slope = length(g);
    if (!(slope >= GRADIENT_MIN)) return e;
    vec3 n = g / slope;
    for (int end = 0; end < 2; ++end) {
        float d = abs((end == 0 ? low : high) - value) / slope;
        if (d < e.d && d <= band) e = Edge(end == 0 ? -n : n, d, 1e9, end == 0 ? EDGE_LOWER : EDGE_UPPER);
    }
    return e;
}

// Invisible voxels have no edge.
bool wanted(ivec3 p) {
    bool visible = in_mask(params.scene.estimate_mask, material_of(voxel(p)));
    if (BURIED == 1u) visible = visible && imageLoad(buried, p).r == 0u;
    if (!visible) imageStore(edges, p, uvec4(0u));
    return visible;
}
#include "shaders/edges/brick_list.glsl"

void main() {
    dims = params.scene.dims;
    ivec3 low_voxel = max(params.scene.core_low - ESTIMATE_MARGIN, ivec3(0));
    uint count = list_brick(low_voxel, min(params.scene.core_low + params.scene.core_size + ESTIMATE_MARGIN, dims));
    for (uint i = gl_LocalInvocationIndex; i < count; i += 64u) {
        ivec3 p = listed_voxel(low_voxel, i);
        float value = voxel(p);
        uint material = material_of(value);
        float low = material == 0u ? -3e38 : params.scene.iso[material - 1u];
        float high = params.scene.iso[material];
        Edge e = Edge(vec3(0.0, 0.0, 1.0), 1e9, 1e9, EDGE_NONE);
        if (ESTIMATOR == TAYLOR) e = extrapolate(p, value, low, high, params.scene.band);
        Beside beside = Beside(0u, 0u);
        if (SURFELS || params.scene.translucent_mask != 0u) {
            vec2 around = values_around(p);
            uint lowest = material_of(around.x);
            // Matter of a missing sample's own material is not there.
            bool missing = has_data(value) && !has_data(around.x);
            IF_ANY(missing) lowest = missing ? min(lowest + 1u, material_of(least_data_around(p))) : lowest;
            beside = Beside(material - lowest, material_of(around.y) - material);
            if (SURFELS) e = find_surfel(p, value, low, high, around);
        }
        if (e.state == EDGE_NONE) {
            vec3 g = voxel_gradient(p);
            float slope = length(g);
            if (slope >= GRADIENT_MIN) e = Edge(-g / slope, 1e9, 1e9, EDGE_NORMAL);
        }
        uint border = 0u;
        if (SURFELS) {
            vec3 out_of = border_beside(p);
            bool ends = dot(out_of, out_of) > 0.0 && (e.state < EDGE_LOWER || abs(e.d) > 0.5);
            if (ends) e = Edge(out_of, 0.5, 1e9, EDGE_LOWER);
            border = ends ? EDGE_BORDER : 0u;
        }
        uvec2 code = e.state == EDGE_NONE ? uvec2(0u) : uvec2(pack_normal(e.n), pack_edge(e) & ~BESIDE_BITS | border);
        code.y |= pack_beside(beside);
        imageStore(edges, p, uvec4(code, 0u, 0u));
    }
}
