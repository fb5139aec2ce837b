// Draws a chunk of surface splats, tile by tile: each pixel counts its splats' votes about the first surfaces on its ray,
// front to back, and stops once the first is decided. 5_shade_surfaces shades it. docs/method.md, 5_draw_surfaces.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_KHR_shader_subgroup_basic : require
#extension GL_KHR_shader_subgroup_arithmetic : require
#include "shaders/drivers/if_any.glsl"
#include "shaders/shared/bindings.h"
#include "shaders/shared/frame_params.h"

layout(local_size_x_id = SPEC_GROUP) in;
#include "shaders/common/groups.glsl"
const uint FOOTPRINTS = PROCEDURAL, WARP = FACE, PAYLOAD = PAYLOAD_NORMAL, SLICED = 0u, TRANSFER = 0u, LIT_EDGES = 0u, ANTIALIAS = 0u, FACE_PIECES = 1u;
layout(constant_id = SPEC_CLIP_KEEP) const uint CLIP_KEEP = 0u;
layout(constant_id = SPEC_CLIP_REMOVE) const uint CLIP_REMOVE = 0u;
layout(constant_id = SPEC_NARROW) const uint NARROW = 0u;
layout(constant_id = SPEC_CREASES) const uint CREASES = 1u;
layout(constant_id = SPEC_TRACED) const uint TRACED = 1u;
layout(constant_id = SPEC_NODES) const uint NODES = 6u;
layout(constant_id = SPEC_COUNT) const uint COUNT = 0u;
layout(constant_id = SPEC_PREPARED) const uint PREPARED = 1u;
layout(constant_id = SPEC_REFINED) const uint REFINED = 0u;
layout(constant_id = SPEC_WIDE_MARKS) const uint WIDE_MARKS = 0u;
layout(constant_id = SPEC_OUTLINES) const uint OUTLINES = 0u;
#include "shaders/common/frame.glsl"
layout(binding = BIND_PREPARED, rgba32f) uniform readonly image2D prepared;
#include "shaders/drivers/texels.glsl"
STORED_PIXELS(BIND_PICTURE, picture, output_pixels, load_pixel, store_pixel)
STORED_WORDS(BIND_OUTLINES, passing, outlines, load_outline, store_outline)
TEXEL_PAIRS(BIND_TILE_ENTRIES, entries, tile_entries, load_entry)
TEXEL_WORDS(BIND_TILE_MARKS, marks, tile_marks, load_mark)
TEXEL_WORDS(BIND_TILE_TODO, todo_pixels, tile_todo, load_todo)
TEXEL_PAIRS(BIND_TILE_RANGES, ranges, tile_ranges, load_range)
TEXEL_WORDS(BIND_TILE_ORDER, order, tile_order, load_order)
TEXEL_WORDS(BIND_TILE_PIXELS, listed_pixels, tile_pixels, load_listed)
layout(push_constant) uniform Push { uint what; };  // as in 5_draw_tiles
#include "shaders/splats/splat_projection.glsl"
#include "shaders/light/shading.glsl"
#include "shaders/common/transfer.glsl"
#include "shaders/splats/splat_inputs.glsl"
#include "shaders/footprints/footprint.glsl"
#include "shaders/splats/prepared_splat.glsl"
FaceForm face_form;
#include "shaders/tiles/outline.glsl"
#define CLIP_PARAMS params.of_volume
#include "shaders/common/clip_ray.glsl"
#include "footprints/in_float.glsl"
#include "engine/geometry/volume_ends.glsl"
#include "shaders/tiles/ray_parts.glsl"
#include "shaders/tiles/tile_marks.glsl"
#include "shaders/tiles/marked_entries.glsl"
#include "shaders/tiles/tile_places.glsl"
#include "shaders/drivers/rounds.glsl"
#include "shaders/splats/traced_ray.glsl"
#include "shaders/tiles/traced_pixel.glsl"
#include "shaders/tiles/sheet_ways.glsl"
#include "shaders/tiles/surface_pixel.glsl"

SurfaceVote vote_of_crease(vec3 p, vec3 u) {
    bool corner = abs(face_form.corner) < FACE_NO_WALL;
    Plane third = Plane(corner ? normalize(corner_normal()) : vec3(0.0), corner ? abs(face_form.corner) : NO_PLANE);
    return vote_of_planes(Plane(face_form.slope, -face_form.value), face_form.crease, third, SURFACE_REACH, p, u);
}

// The vote of a splat that no quadric fits. `ahead`: distance along u from the eye to p.
SurfaceVote vote_of_field(SurfaceVotes front, SeenRay ray, float reach, vec3 p, vec3 u, float ahead) {
    float half_chord = sqrt(max(reach * reach - dot(p, p), 0.0));
    float low = max(ahead - half_chord, 0.0), high = ahead + half_chord;
    bool first = ray.one.x > low && ray.one.x < high;
    bool matter = min(ray.one.y, high) > max(ray.one.x, low) || min(ray.two.y, high) > max(ray.two.x, low);
    // The ray was not traced further than SURFACE_DEEP in matter.
    bool second_deep = ray.two.x < TRACE_NOWHERE && ray.two.y >= TRACE_NOWHERE;
    bool deep = half_chord > 0.0 && ray.last < low && (second_deep || (abs(ray.one.x) < TRACE_NOWHERE && ray.one.y >= TRACE_NOWHERE));
    float entered = second_deep ? ray.two.x : ray.one.x;
    vec3 n_deep = second_deep ? ray.second_normal : ray.first_normal;
    n_deep = (second_deep ? ray.upper.y : ray.upper.x) ? -n_deep : n_deep;
    if (deep) return vote_of_deep(entered, n_deep, ahead, is_seen_before(front, entered));
    // Beyond what else was traced nothing is known.
    matter = matter || ray.last < high - 1e-3;
    vec3 n = first ? ray.first_normal : ray.second_normal;
    n = (first ? ray.upper.x : ray.upper.y) ? -n : n;
    vec2 piece = first ? ray.one : ray.two;
    // Matter soon behind counts, too; all that was not traced counts as matter.
    float until = piece.x + SURFACE_CHORD, chord = piece.y - piece.x + max(until - max(ray.last, piece.y), 0.0);
    chord += first ? max(min(ray.two.y, until) - ray.two.x, 0.0) : 0.0;
    return vote_of_traced(low, high, piece.x, chord, matter, n, reach, p, u, ahead);
}

void main() {
    uint draw_round = what & 0xfffffu;
    uint item = group_number();
    uint groups = REFINED == 1u ? what >> 20 & 0xfu : TILE * TILE / gl_WorkGroupSize.x;
    if (item >= tile_count() * groups) return;
    item = pixels_in_round(item);
    uint tile = item / groups, place = item % groups * gl_WorkGroupSize.x + gl_LocalInvocationIndex;
    if (tile >= tile_count()) return;
    uvec2 range = entries_in_round(load_range(tile), draw_round);
    if (range.x >= range.y) return;
    ivec2 size = params.frame.size;
    uint count = REFINED == 1u ? pixels_of(tile) : TILE * TILE;
    ivec2 pixel = pixel_of(tile, place, count);
    bool inside = pixel.x < size.x && pixel.y < size.y && place < count;
    ivec2 held = min(pixel, size - 1);
    bool was_open = inside && load_pixel(held.y * size.x + held.x).a < params.frame.saturation;
    bool open = was_open;
    uint evaluated = 0u;
    IF_ANY(open) {
        vec2 slope = slopes_of(pixel);
        vec3 across = slope.x * params.of_volume.ray_x + slope.y * params.of_volume.ray_y;
        vec3 way = params.of_volume.ray_z + across;
        float way_length = length(way);
        vec3 u = way / way_length;
        RayParts parts = ray_parts(u);
        SheetWays ways = sheet_ways(u, votes_before());
        SeenRay traced;
        if (TRACED == 1u) traced = load_seen_ray(held);
        int at = int(params.frame.entries_first + range.x), marks_at = first_mark(range.x) + int(cell_of(pixel));
        SurfacePair pair = load_votes(held);
        uint outline = NO_OUTLINE;
        if (OUTLINES == 1u) outline = load_outline(held.y * size.x + held.x);
        uint length = range.y - range.x;
        for (uint base = 0u; base < length && open; base += 4u * MARKED_AT_ONCE) {
            uvec4 words = marks_from(marks_at, base, length);
            while (has_marks(words) && open) {
                uvec2 entry = load_entry(at + int(base + take_mark(words)));
                bool hidden_all = begins_and_hides(pair.front, parts.before.first, params.of_volume.solid);
                open = !hidden_all && !is_decided(pair, way_before(ways, entry.y), params.of_volume.solid);
                PreparedSplat h;
                if (PREPARED == 1u) load_kernel(entry.x, h);
                else h = prepared_splat(UintsRef(params.frame.order).at[entry.x], entry.y);
                face_form = h.inputs.face;
                // Surface splats keep their foot where kernels keep what cuts them.
                vec3 foot = vec3(face_form.cut.depth, face_form.cut.thickness, face_form.cut.reach2);
                uvec2 number_material = h.inputs.number_material;
                vec3 offset = h.start + h.plane * across;
                float beyond = dot(offset, u);
                vec3 p = offset - beyond * u;
                float ahead = h.plane * way_length - beyond;
                if (COUNT == 1u) evaluated += open ? 1u : 0u;
                SurfaceVote vote = vote_of(SurfaceSplat(face_form.value, face_form.slope, face_form.h, foot, SURFACE_REACH), p, u);
                if (CREASES == 1u) {
                    IF_ANY(face_form.crease.away < CREASE_REACH) {
                        if (face_form.crease.away < CREASE_REACH) vote = vote_of_crease(p, u);
                    }
                }
                if (TRACED == 1u) {
                    if ((number_material.y & IS_TRACED) != 0u) vote = vote_of_field(pair.front, traced, h.inputs.color_sigma.w, p, u, ahead);
                }
                // Normals point to the lower values.
                if ((number_material.y & (FACES_UPWARD | IS_TRACED)) == FACES_UPWARD) vote.n = -vote.n;
                float where = ahead + vote.z;
                bool early = vote.enters && enters_just_before(parts.before, where, vote.n, u);
                where = early ? parts.before.first : where;
                vote.n = early ? parts.before.n : vote.n;
                if (CLIP_REMOVE > 0u) {
                    bool late = vote.enters && enters_just_before(parts.behind, where, vote.n, u);
                    where = late ? parts.behind.first : where;
                    vote.n = late ? parts.behind.n : vote.n;
                }
                bool counts = is_in_part(parts.before, where);
                float ends = parts.before.last;
                if (CLIP_REMOVE > 0u) {
                    ends = counts ? ends : parts.behind.last;
                    counts = counts || is_in_part(parts.behind, where);
                }
                vote.chord = min(vote.chord, ends - where);
                vote.weight = open && counts ? vote.weight : 0.0;
                if (OUTLINES == 1u) {
                    bool hidden = wins(pair.front) && where > way_to(pair.front) + SURFACE_WINDOW;
                    bool shows = vote.weight > 0.0 && !hidden, searched = (number_material.y & IS_TRACED) != 0u;
                    face_form.cut.depth = 0.0;
                    face_form.cut.thickness = FACE_NO_WALL;
                    if (shows && !searched) outline = min(outline, outline_of(p, u, ahead, 1.0));
                    if (TRACED == 1u) outline = shows && searched ? min(outline, traced.outline) : outline;
                }
                uint numbered = number_material.x | number_material.y << 28;
                Shown shown = Shown(numbered, ambient_reach(number_material.x, false), lights_reach(number_material.x));
                count_vote(pair, vote, where, shown);
            }
        }
        IF_ANY(was_open) {
            if (was_open) store_votes(held, pair, open || mean_chord(pair.front) < params.of_volume.solid);
            if (OUTLINES == 1u && was_open) store_outline(held.y * size.x + held.x, outline);
            if (was_open && !open) store_pixel(held.y * size.x + held.x, vec4(0.0, 0.0, 0.0, 1.0));
        }
    }
    uint closing = subgroupAdd(was_open && !open ? 1u : 0u);
    if (COUNT == 1u) {
        uint all = subgroupAdd(evaluated);
        if (subgroupElect()) {
            atomicAdd(UintsRef(params.frame.drawn).at[1], all);
            atomicAdd(UintsRef(params.frame.drawn).at[2], all);
        }
    }
    if (subgroupElect() && closing > 0u) atomicAdd(UintsRef(params.frame.tile_closed).at[tile], closing);
}
