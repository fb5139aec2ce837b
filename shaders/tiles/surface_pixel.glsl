// The votes about a pixel, kept between rounds and chunks. Include after shaders/drivers/texels.glsl and
// shaders/footprints/face_record.glsl.
#define Real float
#define INOUT(type) inout type
#include "engine/geometry/surface_votes.glsl"

// The label of a splat.
uint kind_of(uint number) { return LABELS == 1u && number < BEGUN_MATTER ? UintsRef(params.frame.labels).at[number] : 0u; }

STORED_PIXELS(BIND_TILE_SHEETS, unfinished, tile_sheets, load_texel, store_texel)

uint votes_at(ivec2 pixel) { return VOTE_TEXELS * uint(pixel.y * params.frame.size.x + pixel.x); }

SurfaceVotes votes_of(vec4 a, vec4 b, vec2 c) {
    uint number = floatBitsToUint(a.w);
    return SurfaceVotes(a.x, a.y, a.z, c.x, b.xyz, c.y, number, a.x > 0.0 ? kind_of(number) : 0u, b.w);
}

SurfacePair load_votes(ivec2 pixel) {
    uint at = votes_at(pixel);
    vec4 rest = load_texel(at + 4u);
    vec2 passed = load_texel(at + 5u).xy;
    return SurfacePair(votes_of(load_texel(at), load_texel(at + 1u), rest.xy), votes_of(load_texel(at + 2u), load_texel(at + 3u), rest.zw), passed.x,
                       passed.y);
}

void store_votes(ivec2 pixel, SurfacePair pair) {
    uint at = votes_at(pixel);
    SurfaceVotes f = pair.front, b = pair.behind;
    store_texel(at, vec4(f.hits, f.misses, f.way, uintBitsToFloat(f.number)));
    store_texel(at + 1u, vec4(f.normal, f.largest));
    store_texel(at + 2u, vec4(b.hits, b.misses, b.way, uintBitsToFloat(b.number)));
    store_texel(at + 3u, vec4(b.normal, b.largest));
    store_texel(at + 4u, vec4(f.chord, f.arrives, b.chord, b.arrives));
    store_texel(at + 5u, vec4(pair.passed, pair.passed_way, 0.0, 0.0));
}

// Weight of the hits of the first surface; 0: nothing was counted.
float hits_of(ivec2 pixel) { return load_texel(votes_at(pixel)).x; }
