// A chunk of sheets, tile by tile: each pixel adds the splats of a sheet, folds the sheet behind what it has, and stops when it
// is opaque. A subgroup takes as many splats of its tile's list as it has invocations, each invocation prepares one and sees
// whether it touches the subgroup's pixels; those that do are then drawn one after another by all of them.
// docs/method.md, 5_draw_tiles.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_KHR_shader_subgroup_basic : require
#extension GL_KHR_shader_subgroup_vote : require
#extension GL_KHR_shader_subgroup_ballot : require
#extension GL_KHR_shader_subgroup_arithmetic : require
#include "shaders/shared/bindings.h"
#include "shaders/shared/frame_params.h"

layout(local_size_x = 256) in;
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
layout(binding = BIND_TABLE) uniform sampler2DArray table;
layout(binding = BIND_FRAME, scalar) uniform Frame { FrameParams frame; } params;
layout(push_constant) uniform Push { uint draw_round; };
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
FaceBand band;
const bool BANDS = FOOTPRINTS >= 2u && WARP == 0u;  // footprints are integrated between the faces of a plane edge
#define FACE_BAND(d, d2, faces) band
#include "shaders/lib/splat_value.glsl"
#include "shaders/lib/fold_sheet.glsl"

// Consecutive invocations are compact blocks: 8 are 4 x 2 pixels, 32 are 8 x 4, 64 are 8 x 8.
ivec2 pixel_in_tile(uint i) {
    return ivec2((i & 3u) | (i >> 2 & 4u) | (i >> 3 & 8u), (i >> 2 & 1u) | (i >> 2 & 2u) | (i >> 3 & 4u) | (i >> 4 & 8u));
}

// A pixel takes no more once it is opaque.
void fold(inout vec4 sum, inout bool open, vec4 sheet) {
    sum = open ? folded(sum, sheet) : sum;
    open = open && (PAYLOAD == PAYLOAD_TAU || sum.a < params.frame.saturation);
}

void main() {
    uint tile = gl_WorkGroupID.x + gl_WorkGroupID.y * gl_NumWorkGroups.x;
    if (tile >= uint(params.frame.tiles.x * params.frame.tiles.y)) return;
    uvec2 range = PairsRef(params.frame.tile_ranges).at[tile];
    uint whole_end = range.y;
    if (ROUNDS == 1u) range = uvec2(range.x + draw_round * TILE_ROUND, min(range.x + (draw_round + 1u) * TILE_ROUND, range.y));
    if (range.x >= range.y) return;
    // The sheet of the first entry may have begun in the round before, that of the last may go on in the next.
    bool goes_on = ROUNDS == 1u && range.y < whole_end, went_on = ROUNDS == 1u && draw_round > 0u;
    ivec2 size = params.frame.size;
    ivec2 pixel = ivec2(tile % uint(params.frame.tiles.x), tile / uint(params.frame.tiles.x)) * int(TILE) +
                  pixel_in_tile(gl_LocalInvocationIndex);
    bool inside = pixel.x < size.x && pixel.y < size.y;
    ivec2 held = min(pixel, size - 1);
    PixelsRef picture = PixelsRef(params.frame.output_pixels);
    vec4 sum = picture.at[held.y * size.x + held.x];
    bool was_open = inside && (PAYLOAD == PAYLOAD_TAU || sum.a < params.frame.saturation);
    bool open = was_open;
    uint evaluated = 0u, shaded = 0u;
    for (uint run = subgroupAny(open) ? 1u : 0u; run > 0u; --run) {
        vec2 slope = ((vec2(pixel) + 0.5) * 2.0 / vec2(size) - 1.0) * vec2(params.frame.tan_half_x, params.frame.tan_half_y);
        vec3 across = slope.x * params.frame.ray_x + slope.y * params.frame.ray_y;
        vec3 way = params.frame.ray_z + across;
        float way_length = length(way);
        vec3 u = way / way_length;
        float mm = length(params.frame.index_to_world * u);
        // The subgroup's pixels look along `middle`, or `spread` off it.
        vec3 middle = normalize(subgroupAdd(u));
        float spread = 1.01 * subgroupMax(length(u - middle)) + 1e-6;

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
            Splat splat = SplatsRef(params.frame.splats).at[entry.x];
            Edge e = unpack_edge(splat.normal, splat.edge);
            Projection p = place_splat(splat.voxel, e);
            vec2 depths = vec2(0.0);
            if (SLICED == 1u) {
                float near = params.frame.sheet_zero + float(entry.y) * params.frame.sheet_thickness - dot(params.frame.view_z, p.position);
                depths = vec2(near, near + params.frame.sheet_thickness);
                cut_support(p, depths);
            }
            SplatInputs s = splat_inputs(entry.x, splat, e, p, depths);
            vec3 centre = s.from_eye + p.centre;
            float along = dot(centre, middle), far = length(centre);
            float reach = reach_across(p) + spread * far;
            bool touches = mine < range.y && length(centre - along * middle) <= reach && along > -reach;

            // The ray's point at the voxel's depth, or, where the splat may reach the eye, where every ray passes.
            bool at_eye = view_position(p.position + p.centre).z < 1.05 * p.radius * length(params.frame.view_z);
            float plane = at_eye ? params.frame.near_depth : p.view.z;
            vec2 toward = p.view.xy / p.view.z;
            vec3 start = at_eye ? plane * params.frame.ray_z - s.from_eye : -plane * (toward.x * params.frame.ray_x + toward.y * params.frame.ray_y);

            FaceBand own_band;
            if (BANDS) own_band = face_band(e.d, s.shape.x, footprint_faces(e.d, s.shape.x, params.frame.footprint), params.frame.footprint);

            uvec4 hits = subgroupBallot(touches);
            for (uint word = 0u; word * 32u < gl_SubgroupSize; ++word)
            for (uint bits = hits[word]; bits != 0u; bits &= bits - 1u) {
                uint lane = word * 32u + uint(findLSB(bits));
                uint sheet = subgroupBroadcast(entry.y, lane);
                for (uint run = sheet != current ? 1u : 0u; run > 0u; --run) {
                    fold(sum, open, sheet_sum);
                    sheet_sum = vec4(0.0);
                    current = sheet;
                }
                color_sigma = subgroupBroadcast(s.color_sigma, lane);
                if (FOOTPRINTS != ISOTROPIC) normal_distance = subgroupBroadcast(s.normal_distance, lane);
                float curvature = 0.0;
                vec2 cut = vec2(0.0);
                if (CURVED == 1u) curvature = subgroupBroadcast(s.shape.y, lane);
                if (SLICED == 1u) cut = subgroupBroadcast(s.shape.zw, lane);
                shape = vec4(FOOTPRINTS != ISOTROPIC ? subgroupBroadcast(s.shape.x, lane) : -1.0, curvature, cut);
                if (CLIP_KEEP + CLIP_REMOVE > 0u) {
                    from_eye = subgroupBroadcast(s.from_eye, lane);
                    matter = subgroupBroadcast(s.matter, lane);
                    number_material = subgroupBroadcast(s.number_material, lane);
                }
                if (BANDS) {
                    band.a = subgroupBroadcast(own_band.a, lane);
                    band.k = subgroupBroadcast(own_band.k, lane);
                    band.inverse_a = subgroupBroadcast(own_band.inverse_a, lane);
                    band.first = subgroupBroadcast(own_band.first, lane);
                    band.last = subgroupBroadcast(own_band.last, lane);
                }
                float at_plane = subgroupBroadcast(plane, lane);
                vec3 offset = subgroupBroadcast(start, lane) + at_plane * across;
                if (ANTIALIAS == 1u) {
                    from_eye = subgroupBroadcast(s.from_eye, lane);
                    filtered = subgroupBroadcast(s.filtered, lane);
                    pixels = (slope - subgroupBroadcast(toward, lane)) / params.frame.pixel;
                }
                if (COUNT == 1u) {
                    ++evaluated;
                    shaded += open ? 1u : 0u;
                }
                float beyond = dot(offset, u);
                sheet_sum += splat_value(offset - beyond * u, u, at_plane * way_length - beyond, mm);
            }
        }
        // What the next round may go on with is the sheet of the last entry, whether or not it was here.
        bool kept = goes_on && PairsRef(params.frame.tile_entries).at[range.y - 1u].y == current;
        for (uint run = kept ? 0u : 1u; run > 0u; --run) {
            fold(sum, open, sheet_sum);
            sheet_sum = vec4(0.0);
        }
        for (uint write = goes_on && inside ? 1u : 0u; write > 0u; --write) unfinished.at[held.y * size.x + held.x] = sheet_sum;
        for (uint write = was_open ? 1u : 0u; write > 0u; --write) picture.at[held.y * size.x + held.x] = sum;
    }
    uint closing = subgroupAdd(was_open && !open ? 1u : 0u);
    if (COUNT == 1u) {
        uint all = subgroupAdd(evaluated), of_open = subgroupAdd(shaded);
        if (subgroupElect()) {
            atomicAdd(UintsRef(params.frame.drawn).at[2], all);
            atomicAdd(UintsRef(params.frame.drawn).at[3], of_open);
        }
    }
    if (subgroupElect() && closing > 0u) atomicAdd(UintsRef(params.frame.tile_closed).at[tile], closing);
}
