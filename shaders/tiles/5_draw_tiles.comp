// Draws a chunk of sheets, tile by tile: each pixel adds the splats of a sheet, composites the sheet behind its sum,
// and stops when it is saturated. It draws only the entries of its tile's list that are marked for it.
// docs/method.md, 5_draw_tiles.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_KHR_shader_subgroup_basic : require
#extension GL_KHR_shader_subgroup_arithmetic : require
#include "shaders/drivers/if_any.glsl"
#include "shaders/shared/bindings.h"
#include "shaders/shared/frame_params.h"

layout(local_size_x_id = SPEC_GROUP) in;
#include "shaders/common/groups.glsl"
layout(constant_id = SPEC_FOOTPRINTS) const uint FOOTPRINTS = 2u;
layout(constant_id = SPEC_WARP) const uint WARP = FACE;
layout(constant_id = SPEC_NARROW) const uint NARROW = 0u;
layout(constant_id = SPEC_CREASES) const uint CREASES = 1u;
const uint TRACED = 0u;
layout(constant_id = SPEC_PAYLOAD) const uint PAYLOAD = 0u;
layout(constant_id = SPEC_SLICED) const uint SLICED = 0u;
layout(constant_id = SPEC_NODES) const uint NODES = 6u;
layout(constant_id = SPEC_TRANSFER) const uint TRANSFER = 0u;
layout(constant_id = SPEC_LIT_EDGES) const uint LIT_EDGES = 0u;
layout(constant_id = SPEC_CLIP_KEEP) const uint CLIP_KEEP = 0u;
layout(constant_id = SPEC_CLIP_REMOVE) const uint CLIP_REMOVE = 0u;
layout(constant_id = SPEC_ANTIALIAS) const uint ANTIALIAS = 0u;
layout(constant_id = SPEC_PIECES) const uint FACE_PIECES = 2u;
layout(constant_id = SPEC_COUNT) const uint COUNT = 0u;
layout(constant_id = SPEC_PREPARED) const uint PREPARED = 1u;
layout(constant_id = SPEC_REFINED) const uint REFINED = 0u;
layout(constant_id = SPEC_WIDE_MARKS) const uint WIDE_MARKS = 0u;
layout(constant_id = SPEC_OUTLINES) const uint OUTLINES = 0u;
layout(constant_id = SPEC_MIXED) const uint MIXED = 0u;
#include "shaders/common/frame.glsl"
layout(binding = BIND_PREPARED, rgba32f) uniform readonly image2D prepared;
layout(binding = BIND_TABLE) uniform sampler2DArray footprint_layers;
#include "shaders/drivers/texels.glsl"
STORED_PIXELS(BIND_PICTURE, picture, output_pixels, load_pixel, store_pixel)
TEXEL_PAIRS(BIND_TILE_ENTRIES, entries, tile_entries, load_entry)
TEXEL_WORDS(BIND_TILE_MARKS, marks, tile_marks, load_mark)
TEXEL_WORDS(BIND_TILE_TODO, todo_pixels, tile_todo, load_todo)
TEXEL_PAIRS(BIND_TILE_RANGES, ranges, tile_ranges, load_range)
TEXEL_WORDS(BIND_TILE_ORDER, order, tile_order, load_order)
TEXEL_WORDS(BIND_TILE_PIXELS, listed_pixels, tile_pixels, load_listed)
STORED_PIXELS(BIND_TILE_SHEETS, unfinished, tile_sheets, load_unfinished, store_unfinished)
STORED_WORDS(BIND_OUTLINES, passing, outlines, load_outline, store_outline)
layout(push_constant) uniform Push { uint what; };  // round | groups of a tile << 20 | first pixels of refined ones << 31
#include "shaders/splats/splat_projection.glsl"
#include "shaders/light/shading.glsl"
#include "shaders/common/transfer.glsl"
#include "shaders/splats/splat_inputs.glsl"

vec3 from_eye;
vec4 color_sigma;
vec4 normal_distance;
vec3 shape;
vec2 pixels;
vec3 matter;
uvec2 number_material;
vec4 filtered;
FaceForm face_form;
SelectedFootprint selected_footprint;
float ray_end;  // where the ray ends at a surface, from the eye; only with MIXED
#define CLIP_PARAMS params.of_volume
#include "shaders/footprints/footprint.glsl"
#include "shaders/splats/prepared_splat.glsl"
#include "shaders/splats/splat_value.glsl"
#include "shaders/common/fold_sheet.glsl"
#include "shaders/tiles/outline.glsl"
#include "shaders/tiles/tile_marks.glsl"
#include "shaders/tiles/marked_entries.glsl"
#include "shaders/tiles/tile_places.glsl"
#include "shaders/drivers/rounds.glsl"
#include "shaders/tiles/sheet_ways.glsl"
#include "shaders/tiles/seen_surfaces.glsl"

// A pixel's ray in the index space of the splat's volume.
struct VolumeRay {
    vec3 across;       // per mm of depth, from the ray of slopes 0
    float way_length;  // voxels per mm of depth
    vec3 u;
    float mm;          // per voxel
};

VolumeRay ray_in_volume(vec2 slope) {
    VolumeRay ray;
    ray.across = slope.x * params.of_volume.ray_x + slope.y * params.of_volume.ray_y;
    vec3 way = params.of_volume.ray_z + ray.across;
    ray.way_length = length(way);
    ray.u = way / ray.way_length;
    ray.mm = length(params.of_volume.index_to_world * ray.u);
    if (FACES) volume_piece = piece_in_volume(ray.u);
    return ray;
}

// A saturated pixel does not change any more.
void fold(inout vec4 sum, inout bool open, vec4 sheet) {
    sum = open ? folded(sum, sheet) : sum;
    open = open && (PAYLOAD == PAYLOAD_TAU || sum.a < params.frame.saturation);
}

void main() {
    uint draw_round = what & 0xfffffu;
    uint item = group_number();
    uint groups = REFINED == 1u ? what >> 20 & 0xfu : TILE * TILE / gl_WorkGroupSize.x;
    if (item >= tile_count() * groups) return;
    item = pixels_in_round(item);
    uint tile = item / groups, place = item % groups * gl_WorkGroupSize.x + gl_LocalInvocationIndex;
    if (tile >= tile_count()) return;
    uvec2 list = load_range(tile), range = entries_in_round(list, draw_round);
    if (range.x >= range.y) return;
    // The first entry's sheet may have begun in the previous round; the last entry's may continue in the next.
    bool continues = ROUNDS == 1u && range.y < list.y, continued = ROUNDS == 1u && draw_round > 0u;
    ivec2 size = params.frame.size;
    uint count = REFINED == 1u ? pixels_of(tile) : TILE * TILE;
    ivec2 pixel = pixel_of(tile, place, count);
    bool inside = pixel.x < size.x && pixel.y < size.y && place < count;
    ivec2 held = min(pixel, size - 1);
    vec4 sum = load_pixel(held.y * size.x + held.x);
    bool was_open = inside && (PAYLOAD == PAYLOAD_TAU || sum.a < params.frame.saturation);
    bool open = was_open;
    uint evaluated = 0u, shaded = 0u;
    IF_ANY(open) {
        vec2 slope = slopes_of(pixel);
        VolumeRay ray = ray_in_volume(slope);
        float first_mm = ray.mm;
        normal_distance = vec4(0.0);
        int at = int(params.frame.entries_first + range.x), marks_at = first_mark(range.x) + int(cell_of(pixel));
        vec4 sheet_sum = vec4(0.0);
        uint outline = NO_OUTLINE, number = uint(held.y * size.x + held.x);
        if (OUTLINES == 1u) outline = load_outline(held.y * size.x + held.x);
        SheetWays sheets;
        SeenWays surfaces;
        if (MIXED == 1u) {
            sheets = sheet_ways(ray.u, kernels_before());
            surfaces = seen_ways(number);
            ray_end = surfaces.last;
        }
        uint current = load_entry(at).y;
        if (ROUNDS == 1u) {
            bool same = continued && load_entry(at - (continued ? 1 : 0)).y == current;
            sheet_sum = same ? load_unfinished(held.y * size.x + held.x) : vec4(0.0);
            // The unfinished sheet ended with the previous round.
            IF_ANY(continued && !same) fold(sum, open, load_unfinished(held.y * size.x + held.x));
        }
        uint length = range.y - range.x;
        for (uint base = 0u; base < length && open; base += 4u * MARKED_AT_ONCE) {
            uvec4 words = marks_from(marks_at, base, length);
            while (has_marks(words) && open) {
                uvec2 entry = load_entry(at + int(base + take_mark(words)));
                uint sheet = entry.y;
                vec4 with_sheet = sum;
                bool still_open = open;
                fold(with_sheet, still_open, sheet_sum);
                bool ended = sheet != current;
                sum = ended ? with_sheet : sum;
                open = ended ? still_open : open;
                sheet_sum = ended ? vec4(0.0) : sheet_sum;
                current = sheet;
                if (MIXED == 1u) {
                    float way = way_before(sheets, sheet);
                    bool passes = open && surfaces.next < way;
                    IF_ANY(passes) {
                        if (passes) pass_surfaces(sum, surfaces, number, way);
                        open = open && sum.a < params.frame.saturation;
                    }
                }
                PreparedSplat h;
                if (PREPARED == 1u) load_kernel(entry.x, h);
                else h = prepared_splat(enter_volume(UintsRef(params.frame.order).at[entry.x]), sheet);
                if (TOGETHER == 1u) {
                    volume_number = volume_of(h.inputs.color_sigma.w);
                    ray = ray_in_volume(slope);
                    if (MIXED == 1u) ray_end = surfaces.last * (first_mm / ray.mm);
                }
                color_sigma = h.inputs.color_sigma;
                normal_distance = FOOTPRINTS != ISOTROPIC ? h.inputs.normal_distance : vec4(0.0);
                shape = vec3(FOOTPRINTS != ISOTROPIC ? h.inputs.shape.x : -1.0, SLICED == 1u ? h.inputs.shape.yz : vec2(0.0));
                if (FACES) {
                    face_form = h.inputs.face;
                    number_material = h.inputs.number_material;
                }
                if (FOOTPRINTS == TABLE) selected_footprint = h.inputs.selected;
                if (CLIP_KEEP + CLIP_REMOVE > 0u) {
                    from_eye = h.inputs.from_eye;
                    matter = h.inputs.matter;
                    if (!FACES) number_material = h.inputs.number_material;
                }
                vec3 offset = h.start + h.plane * ray.across;
                if (ANTIALIAS == 1u) {
                    filtered = h.inputs.filtered;
                    pixels = (slope - h.slopes) / params.frame.pixel;
                }
                if (COUNT == 1u) {
                    ++evaluated;
                    shaded += open ? 1u : 0u;
                }
                float beyond = dot(offset, ray.u);
                vec3 p = offset - beyond * ray.u;
                float ahead = h.plane * ray.way_length - beyond;
                vec4 value = splat_value(p, ray.u, ahead, ray.mm);
                sheet_sum += value;
                if (OUTLINES == 1u) {
                    bool shows = sum.a < OUTLINE_OPEN && face_form.cut.depth >= 0.0 && dot(p, p) < KERNEL_R2;
                    outline = shows ? min(outline, outline_of(p, ray.u, ahead, value.a)) : outline;
                }
            }
        }
        // The next round may continue the last entry's sheet, even if this pixel drew nothing of it.
        bool kept = continues && load_entry(at + int(range.y - range.x) - 1).y == current;
        IF_ANY(!kept) {
            fold(sum, open, sheet_sum);
            sheet_sum = vec4(0.0);
        }
        IF_ANY(continues && inside) store_unfinished(held.y * size.x + held.x, sheet_sum);
        IF_ANY(was_open) {
            store_pixel(held.y * size.x + held.x, sum);
            if (OUTLINES == 1u) store_outline(held.y * size.x + held.x, outline);
            if (MIXED == 1u && was_open) UintsRef(params.frame.surfaces_passed).at[number] = surfaces.passed;
        }
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
