// Packs the planes that cut a kernel besides its face, at creases and corners; stored instead of second derivatives.
// docs/method.md, 2_collect_splats.
#ifndef EDGESPLAT_CREASE_RECORD_GLSL
#define EDGESPLAT_CREASE_RECORD_GLSL
#include "shaders/edges/edge_record.glsl"
#include "engine/geometry/bending.glsl"

const uint FACE_CREASED = 1u << 31;  // in the first of the two words: the record contains a plane, not second derivatives

// Normal and distance in the format of an edge; the corner's plane as a sign and 13 bits. Bit 30 belongs to faces
// (FACE_MIXED).
uvec2 pack_crease(Plane plane, float corner) {
    int d = int(round(clamp(plane.away / EDGE_DISTANCE_UNIT, -1.0, 1.0) * 32767.0));
    uint third = min(uint(round(abs(corner) / EDGE_DISTANCE_UNIT * 8190.0)), 8191u) | (corner < 0.0 ? 1u << 13 : 0u);
    return uvec2((uint(d) & 0xffffu) | third << 16 | FACE_CREASED, pack_normal(plane.n));
}

float unpack_corner(uvec2 code) {
    uint third = code.x >> 16 & 8191u;
    float distance = float(third) / 8190.0 * EDGE_DISTANCE_UNIT;
    return third == 8191u ? NO_PLANE : (code.x >> 29 & 1u) != 0u ? -distance : distance;
}

Plane unpack_crease(uvec2 code) { return Plane(unpack_normal(code.y), float(int(code.x << 16) >> 16) / 32767.0 * EDGE_DISTANCE_UNIT); }
#endif
