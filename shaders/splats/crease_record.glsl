// The planes that cut a kernel beside its face at a crease and at a corner, stored in place of second derivatives. docs/method.md, 2_collect_splats.
#ifndef EDGESPLAT_CREASE_RECORD_GLSL
#define EDGESPLAT_CREASE_RECORD_GLSL
#include "shaders/edges/edge_record.glsl"

const uint FACE_CREASED = 1u << 31;  // of the first of the two words: a plane, not second derivatives

// A plane: its normal, away from the matter, and its distance from the voxel, CREASE_NONE where there is none.
const vec4 CREASE_NONE = vec4(0.0, 0.0, 0.0, 1e9);

// A third plane, square to face and crease, by its distance: negative where its normal is against their cross product, CORNER_NONE
// where there is none.
const float CORNER_NONE = 1e9;

// Its normal and distance as an edge's; of the corner's plane a sign and 13 bits. Bit 30 is a face's (FACE_MIXED).
uvec2 pack_crease(vec4 plane, float corner) {
    int d = int(round(clamp(plane.w / EDGE_DISTANCE_UNIT, -1.0, 1.0) * 32767.0));
    uint third = min(uint(round(abs(corner) / EDGE_DISTANCE_UNIT * 8190.0)), 8191u) | (corner < 0.0 ? 1u << 13 : 0u);
    return uvec2((uint(d) & 0xffffu) | third << 16 | FACE_CREASED, pack_normal(plane.xyz));
}

float unpack_corner(uvec2 code) {
    uint third = code.x >> 16 & 8191u;
    float distance = float(third) / 8190.0 * EDGE_DISTANCE_UNIT;
    return third == 8191u ? CORNER_NONE : (code.x >> 29 & 1u) != 0u ? -distance : distance;
}

vec4 unpack_crease(uvec2 code) { return vec4(unpack_normal(code.y), float(int(code.x << 16) >> 16) / 32767.0 * EDGE_DISTANCE_UNIT); }
#endif
