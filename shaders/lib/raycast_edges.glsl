// Materials at warped positions: the gathering counterpart of warped splats. docs/method.md, Ray caster.
// Included after raycast.glsl.
#include "shaders/lib/edge_record.glsl"
const uint NODES = 10u;  // of quadrature, which is not done here
#include "shaders/lib/kernel.glsl"

layout(constant_id = SPEC_EDGES) const uint EDGES = 1u;
layout(binding = BIND_EDGES, rg32ui) uniform readonly uimage3D edges;

// One piece of surface: cosine between normals, voxels between planes; fully below and above, not at all beyond.
const vec2 SAME_NORMAL = vec2(0.2, 0.7), SAME_PLACE = vec2(0.5, 1.5);

// The surface near a place; s grows towards lower values along n.
struct Surface {
    vec3 n;
    float s;       // of the place, voxels
    float a, k;    // band and strength
    float weight;  // 0: there is none
};

// The eight voxels around a place and their trilinear weights.
struct Cell {
    ivec3 low, high;
    vec3 t;
};

Cell cell_of(vec3 p) {
    p = clamp(p, vec3(0.0), vec3(dims - 1));
    ivec3 c = ivec3(p);
    return Cell(c, min(c + 1, dims - 1), p - vec3(c));
}

ivec3 corner_of(Cell cell, int i) { return ivec3((i & 1) != 0 ? cell.high.x : cell.low.x, (i & 2) != 0 ? cell.high.y : cell.low.y, (i & 4) != 0 ? cell.high.z : cell.low.z); }

float weight_of(Cell cell, int i) {
    return ((i & 1) != 0 ? cell.t.x : 1.0 - cell.t.x) * ((i & 2) != 0 ? cell.t.y : 1.0 - cell.t.y) * ((i & 4) != 0 ? cell.t.z : 1.0 - cell.t.z);
}

// Extinction (a), and that times colour, of the voxels' own materials between them.
vec4 matter_at(vec3 p) {
    Cell cell = cell_of(p);
    vec4 sum = vec4(0.0);
    for (int i = 0; i < 8; ++i) {
        vec4 material = params.rays.materials[material_of(voxel(corner_of(cell, i)))];
        sum += weight_of(cell, i) * material.a * vec4(material.rgb, 1.0);
    }
    return sum;
}

// The same at x, which a surface of normal n moves to p. Voxels of a surface that faces the other way, across a narrow
// gap, are not moved along with it.
vec4 warped_matter_at(vec3 p, vec3 x, vec3 n) {
    Cell cell = cell_of(p);
    vec4 sum = vec4(0.0);
    for (int i = 0; i < 8; ++i) {
        ivec3 corner = corner_of(cell, i);
        uvec2 code = imageLoad(edges, corner).xy;
        uint state = code.y >> 26 & 3u;
        vec3 outward = state == EDGE_UPPER ? -unpack_normal(code.x) : unpack_normal(code.x);
        bool other = state >= EDGE_LOWER && dot(outward, n) < 0.0;
        vec3 hat = max(1.0 - abs(x - vec3(corner)), 0.0);
        vec4 material = params.rays.materials[material_of(voxel(corner))];
        sum += (other ? hat.x * hat.y * hat.z : weight_of(cell, i)) * material.a * vec4(material.rgb, 1.0);
    }
    return sum;
}

// The face of a voxel's edge that is nearer to the place x; weight 0 where nothing is warped.
Surface face_near(vec3 x, ivec3 p) {
    uvec2 code = imageLoad(edges, p).xy;
    Edge e = unpack_edge(code.x, code.y);
    float reach = KERNEL_R + params.rays.half_width;
    float thickness = e.d + e.d2;
    bool wall = e.d2 < reach;
    Surface f;
    float along = dot(e.n, x - vec3(p));
    bool second = wall && abs(along + e.d2) < abs(along - e.d);
    f.s = second ? -along - e.d2 : along - e.d;
    f.n = second ? -e.n : e.n;
    // Both sides of a surface look for it; their planes are told alike.
    f.s = e.state == EDGE_UPPER ? -f.s : f.s;
    f.n = e.state == EDGE_UPPER ? -f.n : f.n;
    f.a = wall ? wall_half_width(thickness, params.rays.half_width) : params.rays.half_width;
    f.k = wall ? wall_strength(thickness, params.rays.strength) : params.rays.strength;
    f.weight = e.state >= EDGE_LOWER && abs(e.d) < reach && f.k > 1.0 ? 1.0 : 0.0;
    return f;
}

// One surface from the planes of the eight voxels around x that agree with the nearest of them.
Surface surface_near(vec3 x) {
    Surface none = Surface(vec3(0.0, 0.0, 1.0), 1e9, 1.0, 1.0, 0.0);
    if (EDGES == 0u) return none;
    Cell cell = cell_of(x);
    Surface first = none;
    for (int i = 0; i < 8; ++i) {
        Surface f = face_near(x, corner_of(cell, i));
        if (f.weight > 0.0 && abs(f.s) < abs(first.s)) first = f;
    }
    Surface sum = Surface(vec3(0.0), 0.0, 0.0, 0.0, 0.0);
    for (int i = 0; i < 8; ++i) {
        Surface f = face_near(x, corner_of(cell, i));
        float same = smoothstep(SAME_NORMAL.x, SAME_NORMAL.y, dot(f.n, first.n)) *
                     (1.0 - smoothstep(SAME_PLACE.x, SAME_PLACE.y, abs(f.s - first.s)));
        float w = same * f.weight * weight_of(cell, i);
        sum = Surface(sum.n + w * f.n, sum.s + w * f.s, sum.a + w * f.a, sum.k + w * f.k, sum.weight + w);
    }
    float per_weight = 1.0 / max(sum.weight, 1e-20);
    Surface mean = Surface(sum.n * inversesqrt(max(dot(sum.n, sum.n), 1e-20)), sum.s * per_weight, sum.a * per_weight, sum.k * per_weight, 1.0);
    return sum.weight > 1e-6 ? mean : none;
}
