// Packs a face's second derivatives: 8 bytes per splat. docs/method.md, 2_collect_splats.
#ifndef FACE_RECORD_GLSL
#define FACE_RECORD_GLSL

#include "footprints/in_float.glsl"
#include "engine/geometry/bending.glsl"

// Stores the square root: small second derivatives keep a small absolute error.
uint pack_bending(vec3 v) {
    ivec3 code = ivec3(round(clamp(sign(v) * sqrt(abs(v) / BENDING_UNIT), -1.0, 1.0) * 511.0));
    return (uint(code.x) & 1023u) | (uint(code.y) & 1023u) << 10 | (uint(code.z) & 1023u) << 20;
}

const uint FACE_MIXED = 1u << 30;   // in the first word: the face behind is the other end of the interval, lower or upper
const uint FACE_TRACED = 1u << 30;  // in the second word: the quadric fits badly, and rays find the surface

vec3 unpack_bending(uint code) {
    vec3 v = vec3(int(code << 22) >> 22, int(code << 12) >> 22, int(code << 2) >> 22) / 511.0;
    return v * abs(v) * BENDING_UNIT;
}
#endif
