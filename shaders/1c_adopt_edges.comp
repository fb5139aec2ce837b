// A voxel without a trustworthy edge of its own takes the plane of the neighbour whose foot point is nearest.
// docs/method.md, pass 1, step 4. Writes only voxels without an edge and reads only edges that are not adopted, so the
// order of invocations does not show.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/shared/bindings.h"
#include "shaders/lib/edge_record.glsl"

layout(local_size_x = 64) in;
layout(constant_id = SPEC_BURIED) const uint BURIED = 1u;
layout(binding = BIND_VOLUME, r32f) uniform readonly image3D volume;
layout(binding = BIND_EDGES, rg32ui) uniform coherent uimage3D edges;
layout(binding = BIND_BURIED, r8ui) uniform readonly uimage3D buried;
layout(binding = BIND_SCENE, scalar) uniform Scene { SceneParams scene; } params;

#include "shaders/lib/material.glsl"

uint material_at(ivec3 p) { return material_of(imageLoad(volume, p).r); }

bool wanted(ivec3 p) {
    bool wanting = (imageLoad(edges, p).y >> 26 & 3u) < EDGE_LOWER && in_mask(params.scene.visible_mask, material_at(p));
    if (BURIED == 1u) wanting = wanting && imageLoad(buried, p).r == 0u;
    return wanting;
}
#include "shaders/lib/brick_list.glsl"

void main() {
    ivec3 dims = params.scene.dims, low = max(params.scene.core_low - ADOPT_MARGIN, ivec3(0));
    uint count = list_brick(low, min(params.scene.core_low + params.scene.core_size + ADOPT_MARGIN, dims));
    for (uint i = gl_LocalInvocationIndex; i < count; i += 64u) {
        ivec3 p = listed_voxel(low, i);
        uint material = material_at(p);
        Edge best = Edge(vec3(0.0, 0.0, 1.0), 1e9, 1e9, EDGE_NONE);
        float nearest = params.scene.band * params.scene.band;
        for (int z = -2; z <= 2; ++z)
            for (int y = -2; y <= 2; ++y)
                for (int x = -2; x <= 2; ++x) {
                    ivec3 q = p + ivec3(x, y, z);
                    if (any(lessThan(q, ivec3(0))) || any(greaterThanEqual(q, dims))) continue;
                    uvec2 code = imageLoad(edges, q).xy;
                    if ((code.y >> 26 & 3u) < EDGE_LOWER || (code.y & EDGE_ADOPTED) != 0u) continue;
                    Edge e = unpack_edge(code.x, code.y);
                    vec3 foot = vec3(x, y, z) + e.d * e.n;
                    float distance2 = dot(foot, foot);
                    if (distance2 < nearest && material_at(q) == material) {
                        nearest = distance2;
                        float d = dot(e.n, foot);
                        best = Edge(e.n, d, e.d2 < FACE_DISTANCE_UNIT ? max(e.d + e.d2 - d, 0.0) : 1e9, e.state);
                    }
                }
        if (best.state != EDGE_NONE && best.d >= -0.5)
            imageStore(edges, p, uvec4(pack_normal(best.n), pack_edge(best) | EDGE_ADOPTED, 0u, 0u));
    }
}
