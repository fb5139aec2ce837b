// Packs a voxel's edge. The edge field (64 bits) and the splat record use the same format, except that the field stores
// the neighbouring materials (Beside) in the bits of D2. docs/method.md, pass 1.
#ifndef EDGE_RECORD_GLSL
#define EDGE_RECORD_GLSL
#include "shaders/shared/scene_params.h"
#include "footprints/in_float.glsl"
#include "engine/geometry/edge.glsl"

// Cigolle et al. 2014, "A Survey of Efficient Representations for Independent Unit Vectors", octahedral map.
uint pack_normal(vec3 n) {
    vec2 p = n.xy / (abs(n.x) + abs(n.y) + abs(n.z));
    vec2 folded = (1.0 - abs(p.yx)) * vec2(p.x >= 0.0 ? 1.0 : -1.0, p.y >= 0.0 ? 1.0 : -1.0);
    return packSnorm2x16(n.z < 0.0 ? folded : p);
}

vec3 unpack_normal(uint code) {
    vec2 p = vec2(ivec2(int(code) << 16, int(code)) >> 16) * (1.0 / 32767.0);
    vec3 n = vec3(p, 1.0 - abs(p.x) - abs(p.y));
    float fold = max(-n.z, 0.0);
    n.x += n.x >= 0.0 ? -fold : fold;
    n.y += n.y >= 0.0 ? -fold : fold;
    // One division, where normalize() has three.
    return inversesqrt(dot(n, n)) * n;
}

uint pack_edge(Edge e) {
    int d = int(round(clamp(e.d / EDGE_DISTANCE_UNIT, -1.0, 1.0) * 32767.0));
    uint d2 = e.d2 >= FACE_DISTANCE_UNIT ? FACE_NONE : uint(round(max(e.d2, 0.0) / FACE_DISTANCE_UNIT * 1022.0));
    return (uint(d) & 0xffffu) | (d2 << 16) | (e.state << 26);
}

Edge unpack_edge(uint normal_code, uint code) {
    Edge e;
    e.state = (code >> 26) & 3u;
    e.n = unpack_normal(normal_code);
    e.d = float(int(code << 16) >> 16) * (EDGE_DISTANCE_UNIT / 32767.0);
    uint d2 = (code >> 16) & 1023u;
    e.d2 = d2 == FACE_NONE ? 1e9 : float(d2) * (FACE_DISTANCE_UNIT / 1022.0);
    return e;
}

// Numbers of materials below and above a voxel's own that occur between the samples around it.
struct Beside {
    uint below;
    uint above;
};
const uint BESIDE_BITS = 0x3ffu << 16;  // the bits of D2
uint pack_beside(Beside b) { return b.below << 16 | b.above << 20; }
Beside unpack_beside(uint code) { return Beside(code >> 16 & 15u, code >> 20 & 15u); }
#endif
