// The surfaces that a pixel's ray meets, behind translucent matter. Surface splats store them; kernels end at the first
// solid one and composite those that their sheets pass. docs/method/surfaces.md. Include after the declaration of
// `params`.
#ifndef EDGESPLAT_SEEN_SURFACES_GLSL
#define EDGESPLAT_SEEN_SURFACES_GLSL

const float NEVER_SEEN = 1e9;  // instead of the distance, if there is no surface
const uint SEEN_SURFACES = 2u;

struct SeenWays {
    float next;   // to the nearest surface that is not yet in the picture; NEVER_SEEN: none
    float last;   // to the solid surface, where the ray ends; NEVER_SEEN: none
    uint passed;  // number of surfaces in the picture
};

uint seen_at(uint pixel, uint k) { return k * uint(params.frame.size.x * params.frame.size.y) + pixel; }

vec4 seen_surface(uint pixel, uint k) { return PixelsRef(params.frame.seen_surfaces).at[seen_at(pixel, k)]; }

float seen_way(uint pixel, uint k) { return k < SEEN_SURFACES ? FloatsRef(params.frame.seen_ways).at[seen_at(pixel, k)] : NEVER_SEEN; }

void keep_seen(uint pixel, uint k, vec4 surface, float way) {
    PixelsRef(params.frame.seen_surfaces).at[seen_at(pixel, k)] = surface;
    FloatsRef(params.frame.seen_ways).at[seen_at(pixel, k)] = way;
}

SeenWays seen_ways(uint pixel) {
    SeenWays ways = SeenWays(NEVER_SEEN, NEVER_SEEN, UintsRef(params.frame.surfaces_passed).at[pixel]);
    ways.next = seen_way(pixel, ways.passed);
    for (uint k = SEEN_SURFACES; k > 0u; --k) ways.last = seen_surface(pixel, k - 1u).a >= 1.0 ? seen_way(pixel, k - 1u) : ways.last;
    return ways;
}

// Composites the surfaces nearer than `way` behind the sum.
void pass_surfaces(inout vec4 sum, inout SeenWays ways, uint pixel, float way) {
    for (uint k = 0u; k < SEEN_SURFACES; ++k) {
        if (ways.next >= way) continue;
        sum += (1.0 - sum.a) * seen_surface(pixel, ways.passed);
        ++ways.passed;
        ways.next = seen_way(pixel, ways.passed);
    }
}
#endif
