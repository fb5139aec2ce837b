// For every entry of a tile's list: marks the pixels of the tile that its support reaches, row by row. The result is
// one word per pixel and 32 entries. docs/method.md, 4_mark_pixels.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/drivers/if_any.glsl"
#include "shaders/shared/bindings.h"
#include "shaders/shared/frame_params.h"

layout(local_size_x = 8, local_size_y_id = SPEC_LIST_PARTS) in;
#include "shaders/common/groups.glsl"
layout(constant_id = SPEC_FOOTPRINTS) const uint FOOTPRINTS = 2u;
layout(constant_id = SPEC_WARP) const uint WARP = FACE;
layout(constant_id = SPEC_NARROW) const uint NARROW = 0u;
layout(constant_id = SPEC_CREASES) const uint CREASES = 1u;
layout(constant_id = SPEC_TRACED) const uint TRACED = 1u;
layout(constant_id = SPEC_PAYLOAD) const uint PAYLOAD = 0u;
layout(constant_id = SPEC_SLICED) const uint SLICED = 0u;
layout(constant_id = SPEC_NODES) const uint NODES = 6u;
layout(constant_id = SPEC_TRANSFER) const uint TRANSFER = 0u;
layout(constant_id = SPEC_LIT_EDGES) const uint LIT_EDGES = 0u;
layout(constant_id = SPEC_CLIP_KEEP) const uint CLIP_KEEP = 0u;
layout(constant_id = SPEC_CLIP_REMOVE) const uint CLIP_REMOVE = 0u;
layout(constant_id = SPEC_ANTIALIAS) const uint ANTIALIAS = 0u;
layout(constant_id = SPEC_PREPARED) const uint PREPARED = 1u;
layout(constant_id = SPEC_REFINED) const uint REFINED = 0u;
layout(constant_id = SPEC_WIDE_MARKS) const uint WIDE_MARKS = 0u;
#include "shaders/common/frame.glsl"
layout(binding = BIND_PREPARED, rgba32f) uniform readonly image2D prepared;
#include "shaders/drivers/texels.glsl"
TEXEL_WORDS(BIND_TILE_CLOSED, closed_pixels, tile_closed, load_closed)
TEXEL_WORDS(BIND_TILE_TODO, todo_pixels, tile_todo, load_todo)
TEXEL_PAIRS(BIND_TILE_ENTRIES, entries, tile_entries, load_entry)
STORED_WORDS(BIND_TILE_MARKS, marks, tile_marks, load_mark, store_mark)
TEXEL_PAIRS(BIND_TILE_RANGES, ranges, tile_ranges, load_range)
TEXEL_WORDS(BIND_TILE_ORDER, order, tile_order, load_order)
layout(push_constant) uniform Push { uint draw_round; };
#include "shaders/splats/splat_projection.glsl"
#include "shaders/light/shading.glsl"
#include "shaders/common/transfer.glsl"
#include "shaders/splats/splat_inputs.glsl"
#include "shaders/footprints/footprint.glsl"
#include "shaders/splats/prepared_splat.glsl"

#include "shaders/tiles/tile_marks.glsl"
uint tile_count() { return uint(params.frame.tiles.x * params.frame.tiles.y); }
#include "shaders/drivers/rounds.glsl"

// The smallest distance of two voxels, mm.
float least_voxel() {
    mat3 m = params.of_volume.index_to_world;
    return min(length(m[0]), min(length(m[1]), length(m[2])));
}

const uint ROWS = TILE / gl_WorkGroupSize.x;  // per invocation
const uint OWN = ROWS * TILE / (CELL_X * CELL_Y);
const float TOO_WIDE = 1e30;

void main() {
    uint tile = group_number();
    if (tile >= tile_count()) return;
    tile = tile_in_round(tile);
    if (tile >= tile_count()) return;
    uvec2 range = entries_in_round(load_range(tile), draw_round);
    bool closed = load_closed(tile) == load_todo(tile);
    if (range.x >= range.y || closed) return;
    ivec2 corner = ivec2(tile % uint(params.frame.tiles.x), tile / uint(params.frame.tiles.x)) * int(TILE);
    int row = corner.y + int(gl_LocalInvocationID.x * ROWS);
    float finest = TOO_WIDE;
    for (uint base = range.x + MARKED_AT_ONCE * gl_LocalInvocationID.y; base < range.y; base += MARKED_AT_ONCE * gl_WorkGroupSize.y) {
        int marks_at = first_mark(base) + int(gl_LocalInvocationID.x * OWN);
        uint count = min(MARKED_AT_ONCE, range.y - base);
        // Lists kept from the previous step already have marks, except in tiles that were saturated.
        if (REFINED == 1u) count = load_mark(marks_at) == ~0u ? count : 0u;
        uint marked[2u * TILE];
        for (uint c = 0u; c < OWN; ++c) marked[c] = 0u;
        uint traced = 0u;
        for (uint k = 0u; k < count; ++k) {
            uvec2 entry = load_entry(params.frame.entries_first + base + k);
            SplatConic conic;
            if (PREPARED == 1u) conic = load_conic(entry.x);
            else conic = prepared_splat(enter_volume(UintsRef(params.frame.order).at[entry.x]), entry.y).conic;
            if (TOGETHER == 1u && PREPARED == 1u && REFINED == 1u) volume_number = load_volume(entry.x);
            if (REFINED == 1u) {
                float depth = max(conic.depth, params.of_volume.near_depth);
                finest = min(finest, least_voxel() / (depth * 2.0 * params.frame.tan_half_x / float(params.frame.size.x)));
            }
            if (TRACED == 1u) traced |= conic_is_traced(conic) ? 1u << k : 0u;
            uint covered = 0u;
            for (uint r = 0u; r < ROWS; ++r) {
                ivec2 ends = clamp(row_of_conic(conic, row + int(r)) - corner.x, 0, int(TILE));
                uint own = (1u << ends.y) - 1u & ~((1u << ends.x) - 1u);
                covered = WIDE_MARKS == 1u ? covered | own : own;
                if (WIDE_MARKS == 0u)
                    for (uint x = 0u; x < TILE; ++x) marked[r * TILE + x] |= (own >> x & 1u) << k;
            }
            if (WIDE_MARKS == 1u)
                for (uint c = 0u; c < OWN; ++c) marked[c] |= (covered >> c * CELL_X & (1u << CELL_X) - 1u) != 0u ? 1u << k : 0u;
        }
        IF_ANY(count > 0u)
            for (uint c = 0u; c < OWN; ++c) store_mark(marks_at + int(c), marked[c]);
        if (TRACED == 1u) {
            IF_ANY(count > 0u && gl_LocalInvocationID.x == 0u) UintsRef(params.frame.traced_entries).at[word_of(base)] = traced;
        }
    }
    // Interpolation between pixels depends on this splat, even if no drawn pixel lies under it.
    if (REFINED == 1u && gl_LocalInvocationID.x == 0u)
        atomicMin(UintsRef(params.frame.tile_finest).at[tile], floatBitsToUint(finest));
}
