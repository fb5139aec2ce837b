// For every voxel that can be seen: distance and direction to the nearest edge of its own material interval.
// docs/method.md, pass 1, steps 1-3; paper, section 3 (Taylor estimate).
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/shared/bindings.h"
#include "shaders/lib/edge_record.glsl"

layout(local_size_x = 64) in;
layout(constant_id = SPEC_ESTIMATOR) const uint ESTIMATOR = 3u;
layout(constant_id = SPEC_BURIED) const uint BURIED = 1u;
layout(constant_id = SPEC_FACES) const uint FACES = 0u;

layout(binding = BIND_VOLUME, r32f) uniform readonly image3D volume;
layout(binding = BIND_COEFFICIENTS, r32f) uniform readonly image3D coefficients;
layout(binding = BIND_EDGES, rg32ui) uniform writeonly uimage3D edges;
layout(binding = BIND_BURIED, r8ui) uniform readonly uimage3D buried;
layout(binding = BIND_SCENE, scalar) uniform Scene { SceneParams scene; } params;

ivec3 dims;
#include "shaders/lib/material.glsl"
#include "shaders/lib/volume_sampling.glsl"

float field(vec3 p) { return ESTIMATOR == CUBIC ? bspline(p) : trilinear(p); }

// Mean slope over the unit sphere, by the 14-point Lebedev rule: differences along the three axes alone flatten a
// blurred edge by a different amount each and turn its normal by up to 5 degrees.
vec3 field_gradient(vec3 p) {
    vec3 last = vec3(dims - 1);
    vec3 centre = clamp(p, min(vec3(1.0), 0.5 * last), max(last - 1.0, 0.5 * last));
    vec3 g = vec3(0.0);
    for (int i = 0; i < 7; ++i) {
        vec3 axis = vec3(i == 0 ? 1.0 : 0.0, i == 1 ? 1.0 : 0.0, i == 2 ? 1.0 : 0.0);
        vec3 diagonal = vec3((i & 1) != 0 ? -1.0 : 1.0, (i & 2) != 0 ? -1.0 : 1.0, 1.0) * 0.57735027;
        vec3 e = i < 3 ? axis : diagonal;
        g += (i < 3 ? 0.2 : 0.225) * (field(centre + e) - field(centre - e)) * e;
    }
    return g;
}

// (gradient, value).
vec4 field_slope(vec3 p) {
    if (ESTIMATOR == CUBIC) return bspline_slope(p);
    return vec4(field_gradient(p), trilinear(p));
}
#include "shaders/lib/find_surfel.glsl"

// Direction in which the data change most around a voxel: principal axis of the structure tensor; 0 where flat.
vec3 change_axis(ivec3 p) {
    vec3 diagonal = vec3(0.0), mixed = vec3(0.0);  // xx yy zz; yz xz xy
    for (int i = 0; i < 7; ++i) {
        ivec3 o = ivec3(0);
        if (i > 0) o[(i - 1) >> 1] = (i & 1) == 1 ? -1 : 1;
        vec3 g = voxel_gradient(clamp(p + o, ivec3(0), dims - 1));
        diagonal += g * g;
        mixed += g.yxx * g.zzy;
    }
    float trace = diagonal.x + diagonal.y + diagonal.z;
    if (!(trace >= GRADIENT_MIN * GRADIENT_MIN)) return vec3(0.0);
    mat3 t = mat3(diagonal.x, mixed.z, mixed.y, mixed.z, diagonal.y, mixed.x, mixed.y, mixed.x, diagonal.z) / trace;
    vec3 axis = diagonal.x >= diagonal.y && diagonal.x >= diagonal.z ? t[0] : diagonal.y >= diagonal.z ? t[1] : t[2];
    axis = normalize(axis);
    for (int i = 0; i < 8; ++i) axis = normalize(t * axis);
    return axis;
}

struct Hit {
    float t;     // along the walk, voxels; > EDGE_REACH where there is none
    bool upper;  // the interval's upper end was crossed
};

// Walks from the voxel at x along q until the field leaves [low, high), then three steps of regula falsi.
Hit walk(vec3 x, vec3 q, float value, float low, float high) {
    float previous = value, current = value, t = 0.0;
    bool left = false;
    for (int i = 1; i <= 6 && !left; ++i) {
        t = 0.5 * float(i);
        previous = current;
        current = field(x + t * q);
        left = current < low || current >= high;
    }
    Hit hit = Hit(1e9, current >= high);
    float iso = hit.upper ? high : low;
    float a = t - 0.5, fa = previous - iso, b = t, fb = current - iso;
    for (int i = 0; i < (left ? 3 : 0); ++i) {
        float m = a + (b - a) * fa / (fa - fb);
        float fm = field(x + m * q) - iso;
        bool own_side = hit.upper ? fm < 0.0 : fm >= 0.0;
        a = own_side ? m : a;
        fa = own_side ? fm : fa;
        b = own_side ? b : m;
        fb = own_side ? fb : fm;
    }
    if (left) hit.t = a + (b - a) * fa / (fa - fb);
    return hit;
}

// From voxel p along q to where the volume ends, half a voxel beyond its outermost samples.
float way_out(ivec3 p, vec3 q) {
    vec3 x = vec3(params.scene.block_origin + p) + 0.5;
    vec3 room = mix(x, vec3(params.scene.volume_dims) - x, greaterThan(q, vec3(0.0)));
    vec3 t = room / max(abs(q), vec3(1e-6));
    return min(t.x, min(t.y, t.z));
}

Edge march(ivec3 p, float value, float low, float high) {
    Edge e = Edge(vec3(0.0, 0.0, 1.0), 1e9, 1e9, EDGE_NONE);
    vec3 x = vec3(p), axis = change_axis(p);
    Hit hits[2];
    bool has_axis = dot(axis, axis) > 0.0;
    for (int side = 0; side < 2; ++side) {
        hits[side] = Hit(1e9, false);
        if (has_axis) hits[side] = walk(x, side == 0 ? -axis : axis, value, low, high);
    }
    // The nearer hit first; the other only if this one cannot be trusted.
    int first = hits[1].t < hits[0].t ? 1 : 0;
    for (int i = 0; i < 2; ++i) {
        int side = i == 0 ? first : 1 - first;
        Hit hit = hits[side];
        vec3 q = side == 0 ? -axis : axis;
        for (int run = hit.t <= EDGE_REACH && e.state == EDGE_NONE ? 1 : 0; run > 0; --run) {
            vec3 g = field_gradient(x + hit.t * q);
            float steepness = length(g);
            vec3 n = g / max(steepness, 1e-30);
            float alignment = dot(n, q);
            n = alignment < 0.0 ? -n : n;
            alignment = abs(alignment);
            if (steepness >= GRADIENT_MIN && alignment >= 0.5) {
                float other = min(hits[1 - side].t, way_out(p, -q));
                e = Edge(n, hit.t * alignment, other <= EDGE_REACH ? other * abs(dot(axis, n)) : 1e9,
                         hit.upper ? EDGE_UPPER : EDGE_LOWER);
            }
        }
    }
    return e;
}

// One step from the voxel's own derivatives: Taylor (paper; Levoy 1988), or with the curvature along the gradient.
Edge extrapolate(ivec3 p, float value, float low, float high, float band) {
    Edge e = Edge(vec3(0.0, 0.0, 1.0), 1e9, 1e9, EDGE_NONE);
    vec3 g = voxel_gradient(p);
    float slope = length(g);
    if (!(slope >= GRADIENT_MIN)) return e;
    vec3 n = g / slope;
    float curvature = 0.0;
    if (ESTIMATOR == QUADRATIC) {
        ivec3 l = max(p - 1, ivec3(0)), h = min(p + 1, dims - 1);
        float xx = voxel(ivec3(h.x, p.yz)) - 2.0 * value + voxel(ivec3(l.x, p.yz));
        float yy = voxel(ivec3(p.x, h.y, p.z)) - 2.0 * value + voxel(ivec3(p.x, l.y, p.z));
        float zz = voxel(ivec3(p.xy, h.z)) - 2.0 * value + voxel(ivec3(p.xy, l.z));
        float xy = voxel(ivec3(h.xy, p.z)) - voxel(ivec3(h.x, l.y, p.z)) - voxel(ivec3(l.x, h.y, p.z)) + voxel(ivec3(l.xy, p.z));
        float xz = voxel(ivec3(h.x, p.y, h.z)) - voxel(ivec3(h.x, p.y, l.z)) - voxel(ivec3(l.x, p.y, h.z)) + voxel(ivec3(l.x, p.y, l.z));
        float yz = voxel(ivec3(p.x, h.yz)) - voxel(ivec3(p.x, h.y, l.z)) - voxel(ivec3(p.x, l.y, h.z)) + voxel(ivec3(p.x, l.yz));
        curvature = n.x * n.x * xx + n.y * n.y * yy + n.z * n.z * zz +
                    0.5 * (n.x * n.y * xy + n.x * n.z * xz + n.y * n.z * yz);
    }
    for (int end = 0; end < 2; ++end) {
        float iso = end == 0 ? low : high;
        float q = abs(iso - value);
        float bend = end == 0 ? -curvature : curvature;
        float d = ESTIMATOR == QUADRATIC ? 2.0 * q / (slope + sqrt(max(slope * slope + 2.0 * bend * q, 0.0))) : q / slope;
        if (d < e.d && d <= band) e = Edge(end == 0 ? -n : n, d, 1e9, end == 0 ? EDGE_LOWER : EDGE_UPPER);
    }
    return e;
}

// What is not seen has no edge.
bool wanted(ivec3 p) {
    bool visible = in_mask(params.scene.estimate_mask, material_of(voxel(p)));
    if (BURIED == 1u) visible = visible && imageLoad(buried, p).r == 0u;
    if (!visible) imageStore(edges, p, uvec4(0u));
    return visible;
}
#include "shaders/lib/brick_list.glsl"

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
        if (ESTIMATOR == TAYLOR || ESTIMATOR == QUADRATIC) e = extrapolate(p, value, low, high, params.scene.band);
        bool marched = ESTIMATOR == MARCH || ESTIMATOR == CUBIC;
        if (marched && FACES == 0u) e = march(p, value, low, high);
        if (marched && FACES == 1u) e = find_surfel(p, value, low, high);
        if (e.state == EDGE_NONE) {
            vec3 g = voxel_gradient(p);
            float slope = length(g);
            if (slope >= GRADIENT_MIN) e = Edge(-g / slope, 1e9, 1e9, EDGE_NORMAL);
        }
        uint border = 0u;
        if (FACES == 1u && marched) {
            vec3 out_of = border_beside(p);
            bool ends = dot(out_of, out_of) > 0.0 && (e.state < EDGE_LOWER || abs(e.d) > 0.5);
            if (ends) e = Edge(out_of, 0.5, 1e9, EDGE_LOWER);
            border = ends ? EDGE_BORDER : 0u;
        }
        uvec2 code = e.state == EDGE_NONE ? uvec2(0u) : uvec2(pack_normal(e.n), pack_edge(e) | border);
        imageStore(edges, p, uvec4(code, 0u, 0u));
    }
}
