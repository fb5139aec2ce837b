// The plane that cuts a kernel beside its face at a crease, stored in place of second derivatives. docs/method.md, 2_collect_splats.
#ifndef EDGESPLAT_CREASE_RECORD_GLSL
#define EDGESPLAT_CREASE_RECORD_GLSL
#include "shaders/edges/edge_record.glsl"

const uint FACE_CREASED = 1u << 31;  // of the first of the two words: a plane, not second derivatives

// A plane: its normal, away from the matter, and its distance from the voxel, CREASE_NONE where there is none.
const vec4 CREASE_NONE = vec4(0.0, 0.0, 0.0, 1e9);

// Its normal and distance as an edge's.
uvec2 pack_crease(vec4 plane) {
    int d = int(round(clamp(plane.w / EDGE_DISTANCE_UNIT, -1.0, 1.0) * 32767.0));
    return uvec2((uint(d) & 0xffffu) | FACE_CREASED, pack_normal(plane.xyz));
}

vec4 unpack_crease(uvec2 code) { return vec4(unpack_normal(code.y), float(int(code.x << 16) >> 16) / 32767.0 * EDGE_DISTANCE_UNIT); }
#endif
