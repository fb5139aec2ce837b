// A chunk of sheets, tile by tile: each pixel adds the splats of a sheet, folds the sheet behind what it has, and stops when it
// is opaque. A subgroup takes as many splats of its tile's list as it has invocations, each invocation looks whether one of them
// touches the subgroup's pixels; those that do are then drawn one after another by all of them.
// docs/method.md, 5_draw_tiles.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_KHR_shader_subgroup_basic : require
#extension GL_KHR_shader_subgroup_vote : require
#extension GL_KHR_shader_subgroup_ballot : require
#extension GL_KHR_shader_subgroup_arithmetic : require
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
layout(constant_id = SPEC_ROUNDS) const uint ROUNDS = 1u;
layout(constant_id = SPEC_COUNT) const uint COUNT = 0u;
layout(constant_id = SPEC_PREPARED) const uint PREPARED = 1u;
layout(constant_id = SPEC_REFINED) const uint REFINED = 0u;
layout(binding = BIND_TABLE) uniform sampler2DArray table;
layout(binding = BIND_FRAME, scalar) uniform Frame { FrameParams frame; } params;
layout(binding = BIND_PREPARED, rgba32f) uniform readonly image2D prepared;
layout(binding = BIND_PICTURE, rgba32f) uniform imageBuffer picture;
layout(push_constant) uniform Push { uint what; };  // round | groups of a tile << 20 | first pixels of refined ones << 31
#include "shaders/lib/splat_projection.glsl"
#include "shaders/lib/shading.glsl"
#include "shaders/lib/transfer.glsl"
#include "shaders/lib/splat_inputs.glsl"

vec3 from_eye;
vec4 color_sigma;
vec4 normal_distance;
vec4 shape;
vec2 pixels;
vec3 matter;
uvec2 number_material;
vec4 filtered;
#define CLIP_PARAMS params.frame
#include "shaders/lib/footprint.glsl"
#include "shaders/lib/prepared_splat.glsl"
FaceBand band;
#define FACE_BAND(d, d2, faces) band
#include "shaders/lib/splat_value.glsl"
#include "shaders/lib/fold_sheet.glsl"
#include "shaders/lib/pixel_in_tile.glsl"

// A pixel takes no more once it is opaque.
void fold(inout vec4 sum, inout bool open, vec4 sheet) {
    sum = open ? folded(sum, sheet) : sum;
    open = open && (PAYLOAD == PAYLOAD_TAU || sum.a < params.frame.saturation);
}

const float TOO_WIDE = 1e30;

// The least distance of two voxels, mm.
float least_voxel() {
    mat3 m = params.frame.index_to_world;
    return min(length(m[0]), min(length(m[1]), length(m[2])));
}

// Of refined pixels every REFINE_STEP-th comes first, then those that are listed.
const uint FIRST_PIXELS = (TILE / REFINE_STEP) * (TILE / REFINE_STEP);

// Selected, not branched for: lavapipe compiles what a push constant decides anew at every bind.
uint pixels_of(uint tile) { return mix(UintsRef(params.frame.tile_todo).at[tile], FIRST_PIXELS, what >> 31 == 1u); }

ivec2 place_of(uint tile, uint place) {
    if (REFINED == 0u) return pixel_in_tile(place);
    uint listed = UintsRef(params.frame.tile_pixels).at[tile * TILE * TILE + place];
    return mix(ivec2(listed & 0xffu, listed >> 8), int(REFINE_STEP) * pixel_in_tile(place), bvec2(what >> 31 == 1u));
}

void main() {
    uint draw_round = what & 0xfffffu;
    uint item = gl_WorkGroupID.x + gl_WorkGroupID.y * gl_NumWorkGroups.x;
    if (ROUNDS == 1u) item = UintsRef(params.frame.tile_order).at[item];
    uint groups = REFINED == 1u ? what >> 20 & 0xfu : 1u;
    uint tile = item / groups, place = item % groups * gl_WorkGroupSize.x + gl_LocalInvocationIndex;
    if (tile >= uint(params.frame.tiles.x * params.frame.tiles.y)) return;
    uvec2 range = PairsRef(params.frame.tile_ranges).at[tile];
    uint whole_end = range.y;
    if (ROUNDS == 1u) range = uvec2(range.x + draw_round * TILE_ROUND, min(range.x + (draw_round + 1u) * TILE_ROUND, range.y));
    if (range.x >= range.y) return;
    // The sheet of the first entry may have begun in the round before, that of the last may go on in the next.
    bool goes_on = ROUNDS == 1u && range.y < whole_end, went_on = ROUNDS == 1u && draw_round > 0u;
    ivec2 size = params.frame.size;
    uint count = REFINED == 1u ? pixels_of(tile) : TILE * TILE;
    ivec2 pixel = ivec2(tile % uint(params.frame.tiles.x), tile / uint(params.frame.tiles.x)) * int(TILE) +
                  place_of(tile, min(place, max(count, 1u) - 1u));
    bool inside = pixel.x < size.x && pixel.y < size.y && place < count;
    ivec2 held = min(pixel, size - 1);
    vec4 sum = imageLoad(picture, held.y * size.x + held.x);
    bool was_open = inside && (PAYLOAD == PAYLOAD_TAU || sum.a < params.frame.saturation);
    bool open = was_open;
    uint evaluated = 0u, shaded = 0u;
    float finest = TOO_WIDE;
    for (uint run = subgroupAny(open) ? 1u : 0u; run > 0u; --run) {
        vec2 slope = ((vec2(pixel) + 0.5) * 2.0 / vec2(size) - 1.0) * vec2(params.frame.tan_half_x, params.frame.tan_half_y);
        vec3 across = slope.x * params.frame.ray_x + slope.y * params.frame.ray_y;
        vec3 way = params.frame.ray_z + across;
        float way_length = length(way);
        vec3 u = way / way_length;
        float mm = length(params.frame.index_to_world * u);
        // The subgroup's pixels look along `middle`, or up to `spread` off it along two axes across.
        vec3 middle = normalize(subgroupAdd(u));
        vec3 aside = normalize(params.frame.ray_x - dot(params.frame.ray_x, middle) * middle), upward = cross(middle, aside);
        vec3 astray = u / dot(u, middle);
        vec2 spread = 1.01 * vec2(subgroupMax(abs(dot(astray, aside))), subgroupMax(abs(dot(astray, upward)))) + 1e-6;

        normal_distance = vec4(0.0);
        PixelsRef unfinished = PixelsRef(params.frame.tile_sheets);
        vec4 sheet_sum = vec4(0.0);
        uint current = PairsRef(params.frame.tile_entries).at[range.x].y;
        if (ROUNDS == 1u) {
            bool same = went_on && PairsRef(params.frame.tile_entries).at[range.x - (went_on ? 1u : 0u)].y == current;
            sheet_sum = same ? unfinished.at[held.y * size.x + held.x] : vec4(0.0);
            // A sheet that ended with the round before.
            for (uint run = went_on && !same ? 1u : 0u; run > 0u; --run) fold(sum, open, unfinished.at[held.y * size.x + held.x]);
        }
        for (uint base = range.x; base < range.y && subgroupAny(open); base += gl_SubgroupSize) {
            uint mine = base + gl_SubgroupInvocationID;
            uvec2 entry = PairsRef(params.frame.tile_entries).at[min(mine, range.y - 1u)];
            PreparedSplat s;
            if (PREPARED == 1u) load_place(entry.x, s);
            else s = prepared_splat(UintsRef(params.frame.order).at[entry.x], entry.y);
            // From the support's centre to the rays: how far off the nearest of them is, and how far the support reaches that way.
            float along = dot(s.centre, middle);
            vec3 away = along * middle - s.centre;
            float apart = length(away);
            away /= max(apart, 1e-6);
            apart -= (abs(dot(away, aside)) * spread.x + abs(dot(away, upward)) * spread.y) * max(along + s.around, 0.0);
            float reach = s.around;
            if (!SPHERES) {
                float towards = support_towards(s.extents, dot(away, s.inputs.normal_distance.xyz));
                reach = s.is_sphere ? reach : towards;
            }
            bool touches = mine < range.y && along > -s.around && apart <= reach;

            uvec4 hits = subgroupBallot(touches);
            for (uint word = 0u; word * 32u < gl_SubgroupSize; ++word)
            for (uint bits = hits[word]; bits != 0u; bits &= bits - 1u) {
                uint lane = word * 32u + uint(findLSB(bits));
                uint sheet = subgroupBroadcast(entry.y, lane);
                vec4 with_sheet = sum;
                bool still_open = open;
                fold(with_sheet, still_open, sheet_sum);
                bool ended = sheet != current;
                sum = ended ? with_sheet : sum;
                open = ended ? still_open : open;
                sheet_sum = ended ? vec4(0.0) : sheet_sum;
                current = sheet;
                // All load the same record: on lavapipe handing its numbers over one by one takes longer.
                uint drawn = subgroupBroadcast(entry.x, lane);
                PreparedSplat h;
                if (PREPARED == 1u) load_kernel(drawn, h);
                else h = prepared_splat(UintsRef(params.frame.order).at[drawn], sheet);
                if (REFINED == 1u) finest = min(finest, least_voxel() / (h.plane * 2.0 * params.frame.tan_half_x / float(size.x)));
                color_sigma = h.inputs.color_sigma;
                normal_distance = FOOTPRINTS != ISOTROPIC ? h.inputs.normal_distance : vec4(0.0);
                shape = vec4(FOOTPRINTS != ISOTROPIC ? h.inputs.shape.x : -1.0, CURVED == 1u ? h.inputs.shape.y : 0.0,
                             SLICED == 1u ? h.inputs.shape.zw : vec2(0.0));
                if (BANDS) band = h.band;
                if (CLIP_KEEP + CLIP_REMOVE > 0u) {
                    from_eye = h.inputs.from_eye;
                    matter = h.inputs.matter;
                    number_material = h.inputs.number_material;
                }
                vec3 offset = h.start + h.plane * across;
                if (ANTIALIAS == 1u) {
                    filtered = h.inputs.filtered;
                    pixels = (slope - h.slopes) / params.frame.pixel;
                }
                if (COUNT == 1u) {
                    ++evaluated;
                    shaded += open ? 1u : 0u;
                }
                float beyond = dot(offset, u);
                sheet_sum += splat_value(offset - beyond * u, u, h.plane * way_length - beyond, mm);
            }
        }
        // What the next round may go on with is the sheet of the last entry, whether or not it was here.
        bool kept = goes_on && PairsRef(params.frame.tile_entries).at[range.y - 1u].y == current;
        for (uint run = kept ? 0u : 1u; run > 0u; --run) {
            fold(sum, open, sheet_sum);
            sheet_sum = vec4(0.0);
        }
        for (uint write = goes_on && inside ? 1u : 0u; write > 0u; --write) unfinished.at[held.y * size.x + held.x] = sheet_sum;
        for (uint write = was_open ? 1u : 0u; write > 0u; --write) imageStore(picture, held.y * size.x + held.x, sum);
    }
    if (REFINED == 1u) {
        // Also of those that no pixel was under: what is drawn between the pixels depends on it.
        float least = subgroupMin(finest);
        if (subgroupElect()) atomicMin(UintsRef(params.frame.tile_finest).at[tile], floatBitsToUint(least));
    }
    uint closing = subgroupAdd(was_open && !open ? 1u : 0u);
    if (COUNT == 1u) {
        uint all = subgroupAdd(evaluated), of_open = subgroupAdd(shaded);
        if (subgroupElect()) {
            atomicAdd(UintsRef(params.frame.drawn).at[1], all);
            atomicAdd(UintsRef(params.frame.drawn).at[2], of_open);
        }
    }
    if (subgroupElect() && closing > 0u) atomicAdd(UintsRef(params.frame.tile_closed).at[tile], closing);
}
