// The votes about a pixel, kept between rounds and chunks, and whether they decide. Include after
// shaders/drivers/texels.glsl and shaders/splats/splat_projection.glsl.
#define Real float
#define INOUT(type) inout type
#include "engine/geometry/surface_votes.glsl"

// The label of a splat.
uint kind_of(uint number) { return LABELS == 1u && number < BEGUN_MATTER ? UintsRef(params.frame.labels).at[number] : 0u; }

STORED_PIXELS(BIND_TILE_SHEETS, unfinished, tile_sheets, load_texel, store_texel)

uint votes_at(ivec2 pixel) { return VOTE_TEXELS * uint(pixel.y * params.frame.size.x + pixel.x); }

SurfacePair load_votes(ivec2 pixel) {
    uint at = votes_at(pixel);
    vec4 a = load_texel(at), b = load_texel(at + 1u), c = load_texel(at + 2u), d = load_texel(at + 3u), e = load_texel(at + 4u);
    uint front = floatBitsToUint(a.w), behind = floatBitsToUint(c.w);
    return SurfacePair(SurfaceVotes(a.x, a.y, a.z, b.xyz, e.z, front, a.x > 0.0 ? kind_of(front) : 0u, b.w),
                       SurfaceVotes(c.x, c.y, c.z, d.xyz, e.w, behind, c.x > 0.0 ? kind_of(behind) : 0u, d.w), e.x, e.y);
}

void store_votes(ivec2 pixel, SurfacePair pair) {
    uint at = votes_at(pixel);
    SurfaceVotes f = pair.front, b = pair.behind;
    store_texel(at, vec4(f.hits, f.misses, f.way, uintBitsToFloat(f.number)));
    store_texel(at + 1u, vec4(f.normal, f.largest));
    store_texel(at + 2u, vec4(b.hits, b.misses, b.way, uintBitsToFloat(b.number)));
    store_texel(at + 3u, vec4(b.normal, b.largest));
    store_texel(at + 4u, vec4(pair.passed, pair.passed_way, f.arrives, b.arrives));
}

// Weight of the hits of the first surface; 0: nothing was counted.
float hits_of(ivec2 pixel) { return load_texel(votes_at(pixel)).x; }

// How far along a ray splats vote about: the ways to the sheets' first votes are begin + sheet * step.
struct SheetWays {
    float begin, step;
};

SheetWays sheet_ways(vec3 u) {
    float along = 1.0 / dot(params.frame.view_z, u), reach = SURFACE_REACH + (CREASES == 1u ? SURFACE_CREASE : 0.0);
    float begin = params.frame.sheet_zero - dot(params.frame.view_z, params.frame.eye) - reach * length(params.frame.view_z);
    return SheetWays(begin * along, params.frame.sheet_thickness * along);
}

// Whether no splat of the sheet, or of one behind it, votes about the first surface.
bool is_decided(SurfacePair pair, SheetWays ways, uint sheet) {
    return ways.begin + float(sheet) * ways.step > way_to(pair.front) + SURFACE_WINDOW;
}
