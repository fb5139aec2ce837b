// Packs a face's second derivatives: 8 bytes per splat. docs/method.md, 2_collect_splats.
#ifndef FACE_RECORD_GLSL
#define FACE_RECORD_GLSL

// Symmetric matrix: xx yy zz, yz xz xy; 1/voxel.
struct Bending {
    vec3 diagonal;
    vec3 mixed;
};

vec3 bent(Bending h, vec3 v) {
    return vec3(h.diagonal.x * v.x + h.mixed.z * v.y + h.mixed.y * v.z, h.mixed.z * v.x + h.diagonal.y * v.y + h.mixed.x * v.z,
                h.mixed.y * v.x + h.mixed.x * v.y + h.diagonal.z * v.z);
}

float bending_norm(Bending h) { return sqrt(dot(h.diagonal, h.diagonal) + 2.0 * dot(h.mixed, h.mixed)); }

// The larger of the two principal curvatures, valid if H n is small. Outward bending is positive.
float largest_bend(Bending h) {
    float norm = bending_norm(h), sum = h.diagonal.x + h.diagonal.y + h.diagonal.z;
    return 0.5 * (sum + sqrt(max(2.0 * norm * norm - sum * sum, 0.0)));
}

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
