// The intersections of a ray with traced faces. Include after shaders/edges/edge_record.glsl.
#ifndef EDGESPLAT_TRACED_RAY_GLSL
#define EDGESPLAT_TRACED_RAY_GLSL

const float TRACE_NOWHERE = 1e9;

struct TracedRay {
    vec2 one, two;               // pieces of the ray in the matter, voxels from the eye; the first may begin at -TRACE_NOWHERE
    uint first_end, second_end;  // normals where they begin: pack_end()
    float last;                  // the end of the part of the ray that was traced
    uint outline;                // that passes the pixel (outline_word.glsl), or NO_OUTLINE
};

vec4 pieces_texel(TracedRay t) { return vec4(t.one, t.two); }
vec4 ends_texel(TracedRay t) { return vec4(uintBitsToFloat(t.first_end), uintBitsToFloat(t.second_end), t.last, uintBitsToFloat(~t.outline)); }

// The same, unpacked for drawing.
struct SeenRay {
    vec2 one, two;
    vec3 first_normal, second_normal;  // out of the matter
    bvec2 upper;                       // the values beyond these ends are higher
    float last;
    uint outline;
};

SeenRay seen_ray(vec4 pieces, vec4 ends) {
    uvec2 code = floatBitsToUint(ends.xy);
    uint outline = ~floatBitsToUint(ends.w);
    return SeenRay(pieces.xy, pieces.zw, unpack_normal(code.x), unpack_normal(code.y), notEqual(code & 1u, uvec2(0u)), ends.z, outline);
}
#endif
