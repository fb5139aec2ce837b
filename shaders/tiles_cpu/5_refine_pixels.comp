// Fills in the pixels between drawn ones: interpolates them where the picture is smooth, and lists them for drawing
// elsewhere. An invocation processes a cell of STEP x STEP pixels; its first pixel is drawn already. docs/method.md,
// 5_refine_pixels.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/shared/bindings.h"
#include "shaders/shared/frame_params.h"

layout(local_size_x_id = SPEC_GROUP) in;
#include "shaders/common/groups.glsl"
layout(constant_id = SPEC_STEP) const uint STEP = 4u;
layout(constant_id = SPEC_MIXED) const uint MIXED = 0u;
layout(constant_id = SPEC_SURFACES) const uint SURFACES = 0u;
#include "shaders/common/frame.glsl"
#include "shaders/drivers/texels.glsl"
STORED_PIXELS(BIND_PICTURE, picture, output_pixels, load_pixel, store_pixel)
STORED_WORDS(BIND_TILE_PIXELS, pixels, tile_pixels, load_listed, store_listed)
#include "shaders/tiles/pixel_in_tile.glsl"
#include "shaders/tiles/pixel_slopes.glsl"
#include "shaders/tiles/seen_surfaces.glsl"

shared uvec2 rough;  // cells that are listed, one bit each: the lists do not depend on the order of invocations

// Differences are computed on displayed values, not on linear light: close to sRGB, with a finite slope.
vec4 shown(vec4 c) { return vec4(sqrt(max(c.rgb, 0.0) + 0.0015), c.a); }

float largest(vec4 v) { return max(max(v.r, v.g), max(v.b, v.a)); }

vec4 between(vec4 a, vec4 b, vec4 c, vec4 d) { return (9.0 * (b + c) - (a + d)) / 16.0; }

float between(float a, float b, float c, float d) { return (9.0 * (b + c) - (a + d)) / 16.0; }

void keep(ivec2 pixel, vec4 value) { store_pixel(pixel.y * params.frame.size.x + pixel.x, vec4(max(value.rgb, 0.0), clamp(value.a, 0.0, 1.0))); }

// The ways of 4 x 4 pixels around a cell, `apart` pixels from each other, to the surfaces at which their rays end. Of
// surface splats the cells' corners are known, of kernels all pixels are.
struct CellWays {
    float at[4][4];
    bool all_end;  // at solid surfaces
    bool none_ends;
    float bend;  // largest second difference
};

CellWays cell_ways(ivec2 first, ivec2 last, int apart) {
    CellWays ways;
    ways.all_end = true;
    ways.none_ends = true;
    for (int y = 0; y < 4; ++y) {
        for (int x = 0; x < 4; ++x) {
            ivec2 pixel = clamp(first + apart * ivec2(x - 1, y - 1), ivec2(0), last);
            uint number = uint(pixel.y * params.frame.size.x + pixel.x);
            ways.at[y][x] = seen_way(number, 0u);
            ways.none_ends = ways.none_ends && ways.at[y][x] >= NEVER_SEEN;
            ways.all_end = ways.all_end && seen_surface(number, 0u).a >= 1.0;
        }
    }
    ways.bend = 0.0;
    for (int i = 1; i < 3; ++i) {
        for (int j = 0; j < 2; ++j) {
            ways.bend = max(ways.bend, abs(ways.at[i][j] - 2.0 * ways.at[i][j + 1] + ways.at[i][j + 2]));
            ways.bend = max(ways.bend, abs(ways.at[j][i] - 2.0 * ways.at[j + 1][i] + ways.at[j + 2][i]));
        }
    }
    return ways;
}

void keep_surface(ivec2 pixel, vec4 value, float way, bool ends, uint tile) {
    uint number = uint(pixel.y * params.frame.size.x + pixel.x);
    keep_seen(number, 0u, ends ? vec4(max(value.rgb, 0.0) / max(value.a, 0.5), 1.0) : vec4(0.0), ends ? way : NEVER_SEEN);
    keep_seen(number, 1u, vec4(0.0), NEVER_SEEN);
    vec2 slope = slopes_of(pixel);
    vec3 u = normalize(params.of_volume.ray_z + slope.x * params.of_volume.ray_x + slope.y * params.of_volume.ray_y);
    float end = max(way * dot(params.of_volume.view_z, u), 0.0);
    if (ends) atomicMax(UintsRef(params.frame.tile_ends).at[tile], floatBitsToUint(end));
}

void main() {
    uint tile = group_number();
    if (tile >= uint(params.frame.tiles.x * params.frame.tiles.y)) return;
    ivec2 corner = ivec2(tile % uint(params.frame.tiles.x), tile / uint(params.frame.tiles.x)) * int(TILE);
    ivec2 size = params.frame.size, in_tile = pixel_in_tile(gl_LocalInvocationIndex) * int(STEP), first = corner + in_tile;
    ivec2 last = (size - 1) / int(STEP) * int(STEP);
    vec4 at[4][4], seen[4][4];
    for (int y = 0; y < 4; ++y) {
        for (int x = 0; x < 4; ++x) {
            ivec2 pixel = clamp(first + int(STEP) * ivec2(x - 1, y - 1), ivec2(0), last);
            at[y][x] = load_pixel(pixel.y * size.x + pixel.x);
            seen[y][x] = shown(at[y][x]);
        }
    }
    vec4 bend = vec4(0.0);
    for (int i = 1; i < 3; ++i) {
        for (int j = 0; j < 2; ++j) {
            bend = max(bend, abs(seen[i][j] - 2.0 * seen[i][j + 1] + seen[i][j + 2]));
            bend = max(bend, abs(seen[j][i] - 2.0 * seen[j + 1][i] + seen[j + 2][i]));
        }
    }
    for (int y = 0; y < 3; ++y)
        for (int x = 0; x < 3; ++x)
            bend = max(bend, abs(seen[y][x] - seen[y][x + 1] - seen[y + 1][x] + seen[y + 1][x + 1]));
    // NaN is not smooth, and neither is a cell at the picture's side. Details of voxels narrower than a step may lie
    // between samples.
    float finest = uintBitsToFloat(UintsRef(params.frame.tile_finest).at[tile]);
    bool smooth_here = largest(bend) <= REFINE_TOLERANCE && all(lessThanEqual(first + int(STEP), last)) && finest >= float(STEP);

    const int half_step = int(STEP / 2u);
    CellWays ways;
    if (MIXED == 1u) {
        ways = cell_ways(first, last, SURFACES == 1u ? int(STEP) : half_step);
        smooth_here = smooth_here && (ways.none_ends || (ways.all_end && ways.bend <= REFINE_WAY));
    }

    bool right = first.x + half_step < size.x && first.y < size.y, below = first.x < size.x && first.y + half_step < size.y;
    if (smooth_here) {
        vec4 rows[4];
        for (int y = 0; y < 4; ++y) rows[y] = between(at[y][0], at[y][1], at[y][2], at[y][3]);
        vec4 column = between(at[0][1], at[1][1], at[2][1], at[3][1]), middle = between(rows[0], rows[1], rows[2], rows[3]);
        keep(first + ivec2(half_step, 0), rows[1]);
        keep(first + ivec2(0, half_step), column);
        keep(first + half_step, middle);
        if (MIXED == 1u && SURFACES == 1u) {
            float way_rows[4];
            for (int y = 0; y < 4; ++y) way_rows[y] = between(ways.at[y][0], ways.at[y][1], ways.at[y][2], ways.at[y][3]);
            float way_column = between(ways.at[0][1], ways.at[1][1], ways.at[2][1], ways.at[3][1]);
            float way_middle = between(way_rows[0], way_rows[1], way_rows[2], way_rows[3]);
            keep_surface(first + ivec2(half_step, 0), rows[1], way_rows[1], ways.all_end, tile);
            keep_surface(first + ivec2(0, half_step), column, way_column, ways.all_end, tile);
            keep_surface(first + half_step, middle, way_middle, ways.all_end, tile);
        }
    }
    uint me = gl_LocalInvocationIndex;
    if (me == 0u) rough = uvec2(0u);
    barrier();
    bool is_rough = !smooth_here && (right || below);
    if (is_rough) atomicOr(rough[me / 32u], 1u << (me % 32u));
    barrier();
    uvec2 before = rough & uvec2(me < 32u ? (1u << me) - 1u : 0xffffffffu, me < 32u ? 0u : (1u << (me - 32u)) - 1u);
    if (is_rough) {
        // Pixels outside the picture may be listed; they are not drawn.
        uint place = tile * TILE * TILE + 3u * uint(bitCount(before.x) + bitCount(before.y));
        uint code = uint(in_tile.x | in_tile.y << 8), half_code = uint(half_step);
        store_listed(place, code + half_code);
        store_listed(place + 1u, code + (half_code << 8));
        store_listed(place + 2u, code + half_code + (half_code << 8));
    }
    if (me == 0u) {
        UintsRef(params.frame.tile_todo).at[tile] = 3u * uint(bitCount(rough.x) + bitCount(rough.y));
        UintsRef(params.frame.tile_closed).at[tile] = 0u;
    }
}
