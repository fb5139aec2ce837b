// The votes about a pixel, kept between rounds and chunks. Include after shaders/drivers/texels.glsl and
// shaders/footprints/face_record.glsl.
#include "footprints/in_float.glsl"
#include "engine/geometry/surface_votes.glsl"

// SurfaceVotes::number on the device: bits 0-27 the splat's number, 28-31 the material that is shown.
uint splat_of(uint number) { return number & NUMBERED_SPLATS; }

STORED_PIXELS(BIND_TILE_SHEETS, unfinished, tile_sheets, load_texel, store_texel)

// Where the k-th of a pixel's VOTE_TEXELS texels lies; with shadows, one more contains the shares of their lights.
uint vote_texel(ivec2 pixel, uint k) {
    ivec2 size = params.frame.size;
    return k * uint(size.x * size.y) + uint(pixel.y * size.x + pixel.x);
}

// A pixel without votes has a first texel only, with negative misses.
void forget_votes(ivec2 pixel) { store_texel(vote_texel(pixel, 0u), vec4(0.0, -1.0, 0.0, 0.0)); }

SurfaceVotes load_surface(ivec2 pixel, uint first) {
    vec4 a = load_texel(vote_texel(pixel, first)), b = load_texel(vote_texel(pixel, first + 1u));
    vec2 c = load_texel(vote_texel(pixel, first + 2u)).xy;
    uint number = floatBitsToUint(a.w);
    vec2 lights = vec2(0.0);
    if (SHADOWS > 0u) {
        vec4 both = load_texel(vote_texel(pixel, VOTE_TEXELS));
        lights = first == 0u ? both.xy : both.zw;
    }
    return SurfaceVotes(a.x, a.y, a.z, c.x, b.xyz, c.y, lights, number, b.w);
}

void store_surface(ivec2 pixel, uint first, SurfaceVotes votes, vec2 passed) {
    store_texel(vote_texel(pixel, first), vec4(votes.hits, votes.misses, votes.way, uintBitsToFloat(votes.number)));
    store_texel(vote_texel(pixel, first + 1u), vec4(votes.normal, votes.largest));
    store_texel(vote_texel(pixel, first + 2u), vec4(votes.chord, votes.arrives, passed));
}

// The first surface; without votes if `some` is false.
SurfaceVotes load_front(ivec2 pixel, bool some) {
    SurfaceVotes votes = no_votes();
    some = some && load_texel(vote_texel(pixel, 0u)).y >= 0.0;
    IF_ANY(some) {
        if (some) votes = load_surface(pixel, 0u);
    }
    return votes;
}

SurfacePair load_votes(ivec2 pixel) {
    SurfacePair pair = no_surfaces();
    bool some = load_texel(vote_texel(pixel, 0u)).y >= 0.0;
    IF_ANY(some) {
        if (some) {
            vec2 passed = load_texel(vote_texel(pixel, 5u)).zw;
            pair = SurfacePair(load_surface(pixel, 0u), load_surface(pixel, 3u), passed.x, passed.y);
        }
    }
    return pair;
}

// `whole`: also the second surface, which pixels with a solid first one do not show.
void store_votes(ivec2 pixel, SurfacePair pair, bool whole) {
    store_surface(pixel, 0u, pair.front, vec2(0.0));
    IF_ANY(whole) {
        if (whole) store_surface(pixel, 3u, pair.behind, vec2(pair.passed, pair.passed_way));
    }
    if (SHADOWS > 0u) store_texel(vote_texel(pixel, VOTE_TEXELS), vec4(pair.front.lights, pair.behind.lights));
}
