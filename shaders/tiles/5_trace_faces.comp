// Before a round is drawn: traces its pixels' rays through the splats whose faces rays find.
// docs/method.md, 5_trace_faces.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/drivers/if_any.glsl"
#include "shaders/shared/bindings.h"
#include "shaders/shared/frame_params.h"

layout(local_size_x_id = SPEC_GROUP) in;
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
layout(constant_id = SPEC_OUTLINES) const uint OUTLINES = 0u;
layout(constant_id = SPEC_PREPARED) const uint PREPARED = 1u;
layout(constant_id = SPEC_REFINED) const uint REFINED = 0u;
layout(constant_id = SPEC_WIDE_MARKS) const uint WIDE_MARKS = 0u;
#include "shaders/common/frame.glsl"
layout(binding = BIND_COEFFICIENTS, r32f) uniform readonly image3D coefficients;
layout(binding = BIND_VOLUME, r32f) uniform readonly image3D volume;
layout(binding = BIND_PREPARED, rgba32f) uniform readonly image2D prepared;
#include "shaders/drivers/texels.glsl"
TEXEL_PIXELS(BIND_PICTURE, picture, output_pixels, load_pixel)
TEXEL_PAIRS(BIND_TILE_ENTRIES, entries, tile_entries, load_entry)
TEXEL_WORDS(BIND_TILE_MARKS, marks, tile_marks, load_mark)
TEXEL_WORDS(BIND_TILE_TODO, todo_pixels, tile_todo, load_todo)
TEXEL_PAIRS(BIND_TILE_RANGES, ranges, tile_ranges, load_range)
TEXEL_WORDS(BIND_TILE_ORDER, order, tile_order, load_order)
TEXEL_WORDS(BIND_TILE_PIXELS, listed_pixels, tile_pixels, load_listed)
layout(push_constant) uniform Push { uint what; };  // as in 5_draw_tiles
ivec3 dims;
#include "shaders/common/volume_sampling.glsl"
#include "shaders/splats/splat_projection.glsl"
#include "shaders/light/shading.glsl"
#include "shaders/common/transfer.glsl"
#include "shaders/splats/splat_inputs.glsl"
#include "shaders/footprints/footprint.glsl"
#include "shaders/splats/prepared_splat.glsl"
#include "shaders/splats/trace_ray.glsl"
#include "shaders/tiles/tile_marks.glsl"
#include "shaders/tiles/tile_places.glsl"
#include "shaders/drivers/rounds.glsl"
#include "shaders/tiles/traced_pixel.glsl"
#define CLIP_PARAMS params.of_volume
#include "shaders/common/clip_ray.glsl"
#include "shaders/tiles/ray_parts.glsl"

// The part of a pixel's ray from the first to the last kernel of the traced entries.
Stretch traced_stretch(uvec2 range, ivec2 pixel, vec3 across, vec3 u, float way_length) {
    Stretch found = NO_STRETCH;
    int at = int(params.frame.entries_first + range.x), marks_at = first_mark(range.x) + int(cell_of(pixel));
    uint length = range.y - range.x;
    for (uint base = 0u; base < length; base += MARKED_AT_ONCE) {
        uint bits = traced_word(word_of(range.x + base));
        IF_ANY(bits != 0u) {
            bits &= load_mark(marks_at + int(base / MARKED_AT_ONCE * CELLS));
            while (bits != 0u) {
                uvec2 entry = load_entry(at + int(base) + findLSB(bits));
                bits &= bits - 1u;
                vec4 start;
                float reach;
                if (PREPARED == 1u) {
                    start = load_start(entry.x);
                    reach = load_reach(entry.x);
                } else {
                    PreparedSplat s = prepared_splat(UintsRef(params.frame.order).at[entry.x], entry.y);
                    start = vec4(s.start, s.plane);
                    reach = s.inputs.color_sigma.w;
                }
                vec3 offset = start.xyz + start.w * across;
                float beyond = dot(offset, u), ahead = start.w * way_length - beyond;
                vec3 p = offset - beyond * u;
                Stretch own = kernel_stretch(p, reach, ahead);
                found = Stretch(min(found.first, own.first), max(found.last, own.last));
            }
        }
    }
    return found;
}

// The ray's first pieces in the matter that clip planes keep.
TracedRay trace_kept(vec3 u, Stretch along) {
    vec3 from = params.of_volume.anchor + params.of_volume.eye;
    RayParts parts = ray_parts(u);
    TracedRay ray = trace_ray(from, u, along, Stretch(parts.before.first, parts.before.last));
    bool goes_on = ray.one.x >= TRACE_NOWHERE && along.last > parts.behind.first;
    if (CLIP_REMOVE > 0u) {
        IF_ANY(goes_on) {
            TracedRay rest = trace_ray(from, u, along, Stretch(parts.behind.first, parts.behind.last));
            if (goes_on) ray = rest;
        }
    }
    return ray;
}

void main() {
    uint draw_round = what & 0xfffffu, tile = group_number();
    if (tile >= tile_count()) return;
    tile = tile_in_round(tile);
    if (tile >= tile_count()) return;
    uvec2 range = entries_in_round(load_range(tile), draw_round);
    uint any = 0u;
    for (uint base = range.x; base < range.y; base += MARKED_AT_ONCE) any |= traced_word(word_of(base));
    if (any == 0u) return;
    ivec2 size = params.frame.size, corner = int(TILE) * ivec2(tile % uint(params.frame.tiles.x), tile / uint(params.frame.tiles.x));
    uint count = REFINED == 1u ? pixels_of(tile) : TILE * TILE;
    dims = params.of_volume.dims;
    for (uint place = gl_LocalInvocationIndex; place < count; place += gl_WorkGroupSize.x) {
        ivec2 pixel = corner + place_of(tile, place), held = min(pixel, size - 1);
        bool inside = all(lessThan(pixel, size));
        bool open = inside && load_pixel(held.y * size.x + held.x).a < params.frame.saturation;
        IF_ANY(open) {
            vec2 slope = slopes_of(pixel);
            vec3 across = slope.x * params.of_volume.ray_x + slope.y * params.of_volume.ray_y;
            vec3 way = params.of_volume.ray_z + across;
            float way_length = length(way);
            vec3 u = way / way_length;
            Stretch along = traced_stretch(range, pixel, across, u, way_length);
            IF_ANY(along.first < along.last) {
                TracedRay ray = trace_kept(u, along);
                PixelsRef(params.frame.traced_rays).at[traced_at(held)] = pieces_texel(ray);
                PixelsRef(params.frame.traced_rays).at[traced_at(held) + 1u] = ends_texel(ray);
            }
        }
    }
}
