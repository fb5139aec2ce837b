// For every entry of a tile's list: which of the tile's blocks of 4 x 2 pixels its support reaches, found once for the
// entry instead of by each block for all entries. docs/method.md, 4_mark_blocks.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/shared/bindings.h"
#include "shaders/shared/frame_params.h"

layout(local_size_x_id = SPEC_GROUP) in;
layout(constant_id = SPEC_FOOTPRINTS) const uint FOOTPRINTS = 3u;
layout(constant_id = SPEC_WARP) const uint WARP = 0u;
layout(constant_id = SPEC_PAYLOAD) const uint PAYLOAD = 0u;
layout(constant_id = SPEC_SLICED) const uint SLICED = 0u;
layout(constant_id = SPEC_CURVED) const uint CURVED = 0u;
layout(constant_id = SPEC_NODES) const uint NODES = 8u;
layout(constant_id = SPEC_WEIGHTED) const uint WEIGHTED = 0u;
layout(constant_id = SPEC_TRANSFER) const uint TRANSFER = 0u;
layout(constant_id = SPEC_LIT_EDGES) const uint LIT_EDGES = 0u;
layout(constant_id = SPEC_CLIP_KEEP) const uint CLIP_KEEP = 0u;
layout(constant_id = SPEC_CLIP_REMOVE) const uint CLIP_REMOVE = 0u;
layout(constant_id = SPEC_ANTIALIAS) const uint ANTIALIAS = 0u;
layout(constant_id = SPEC_PREPARED) const uint PREPARED = 1u;
layout(constant_id = SPEC_REFINED) const uint REFINED = 0u;
layout(constant_id = SPEC_ROUNDS) const uint ROUNDS = 1u;
layout(binding = BIND_FRAME, scalar) uniform Frame { FrameParams frame; } params;
layout(binding = BIND_PREPARED, rgba32f) uniform readonly image2D prepared;
layout(binding = BIND_TILE_CLOSED, r32ui) uniform readonly uimageBuffer closed_pixels;
layout(binding = BIND_TILE_TODO, r32ui) uniform readonly uimageBuffer todo_pixels;
layout(binding = BIND_TILE_ENTRIES, rg32ui) uniform readonly uimageBuffer entries;
layout(binding = BIND_TILE_MARKS, r32ui) uniform uimageBuffer marks;
layout(push_constant) uniform Push { uint draw_round; };
#include "shaders/lib/splat_projection.glsl"
#include "shaders/lib/shading.glsl"
#include "shaders/lib/transfer.glsl"
#include "shaders/lib/splat_inputs.glsl"
#include "shaders/lib/footprint.glsl"
#include "shaders/lib/prepared_splat.glsl"

#include "shaders/lib/tile_blocks.glsl"

// The rays of a block's pixels: none is further off `middle` than `spread`, along `aside` and along what is across both.
struct Rays {
    vec3 middle, aside;
    vec2 spread;
};

Rays rays_of(uint tile, uint block) {
    vec2 scale = 2.0 * vec2(params.frame.tan_half_x, params.frame.tan_half_y) / vec2(params.frame.size);
    vec2 place = vec2(uvec2(tile % uint(params.frame.tiles.x), tile / uint(params.frame.tiles.x)) * TILE + block_corner(block));
    vec2 slope = (place + 0.5 * vec2(BLOCK)) * scale - vec2(params.frame.tan_half_x, params.frame.tan_half_y);
    vec2 reach = 0.5 * (vec2(BLOCK) - 1.0) * scale;
    vec3 x = params.frame.ray_x, y = params.frame.ray_y;
    vec3 way = params.frame.ray_z + slope.x * x + slope.y * y;
    float way_length = length(way);
    Rays r;
    r.middle = way / way_length;
    r.aside = normalize(x - dot(x, r.middle) * r.middle);
    vec3 upward = cross(r.middle, r.aside);
    float least = way_length - reach.x * abs(dot(x, r.middle)) - reach.y * abs(dot(y, r.middle));
    r.spread = 1.01 * vec2(reach.x * dot(x, r.aside) + reach.y * abs(dot(y, r.aside)), reach.y * abs(dot(y, upward))) /
                   max(least, 1e-3 * way_length) + 1e-6;
    return r;
}

// The least distance of two voxels, mm.
float least_voxel() {
    mat3 m = params.frame.index_to_world;
    return min(length(m[0]), min(length(m[1]), length(m[2])));
}

const uint EACH = BLOCKS / gl_WorkGroupSize.x;
const float TOO_WIDE = 1e30;

void main() {
    uint tile = gl_WorkGroupID.x + gl_WorkGroupID.y * gl_NumWorkGroups.x;
    if (ROUNDS == 1u) tile = UintsRef(params.frame.tile_order).at[tile];
    if (tile >= uint(params.frame.tiles.x * params.frame.tiles.y)) return;
    uvec2 range = PairsRef(params.frame.tile_ranges).at[tile];
    if (ROUNDS == 1u) range = uvec2(range.x + round_begin(draw_round), min(range.x + round_begin(draw_round + 1u), range.y));
    bool closed = imageLoad(closed_pixels, int(tile)).x == imageLoad(todo_pixels, int(tile)).x;
    if (range.x >= range.y || closed) return;
    uint own = gl_LocalInvocationIndex * EACH;
    Rays rays[BLOCKS];
    for (uint j = 0u; j < EACH; ++j) rays[j] = rays_of(tile, own + j);
    float finest = TOO_WIDE;
    for (uint base = range.x; base < range.y; base += MARKED_AT_ONCE) {
        int at = int(params.frame.entries_first + base);
        uint count = min(MARKED_AT_ONCE, range.y - base);
        // Lists that are kept from step to step are marked already, where tiles were not closed.
        if (REFINED == 1u) count = imageLoad(marks, at + int(own)).x == ~0u ? count : 0u;
        uint marked[BLOCKS];
        for (uint j = 0u; j < EACH; ++j) marked[j] = 0u;
        for (uint k = 0u; k < count; ++k) {
            uvec2 entry = imageLoad(entries, at + int(k)).xy;
            PreparedSplat s;
            if (PREPARED == 1u) load_place(entry.x, s);
            else s = prepared_splat(UintsRef(params.frame.order).at[entry.x], entry.y);
            if (REFINED == 1u) {
                float depth = max(dot(params.frame.view_z, s.centre), params.frame.near_depth);
                finest = min(finest, least_voxel() / (depth * 2.0 * params.frame.tan_half_x / float(params.frame.size.x)));
            }
            for (uint j = 0u; j < EACH; ++j) {
                // From the support's centre to the rays: how far off the nearest is, and how far the support reaches that way.
                float along = dot(s.centre, rays[j].middle);
                vec3 away = along * rays[j].middle - s.centre;
                float apart = length(away);
                away /= max(apart, 1e-6);
                float aside = abs(dot(away, rays[j].aside));
                apart -= (aside * rays[j].spread.x + sqrt(max(1.0 - aside * aside, 0.0)) * rays[j].spread.y) *
                         max(along + s.around, 0.0);
                float reach = s.around;
                if (!SPHERES) {
                    float towards = support_towards(s.extents, dot(away, s.inputs.normal_distance.xyz));
                    reach = s.is_sphere ? reach : towards;
                }
                marked[j] |= along > -s.around && apart <= reach ? 1u << k : 0u;
            }
        }
        for (uint store = count > 0u ? 1u : 0u; store > 0u; --store)
            for (uint j = 0u; j < EACH; ++j) imageStore(marks, at + int(own + j), uvec4(marked[j]));
    }
    // What is drawn between pixels depends on it, also where no pixel that is drawn was under the splat.
    if (REFINED == 1u && gl_LocalInvocationIndex == 0u)
        atomicMin(UintsRef(params.frame.tile_finest).at[tile], floatBitsToUint(finest));
}
