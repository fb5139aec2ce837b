// Decides the surface that each pixel's ray enters, and shades it there, once a pixel. After a part of a picture: only
// marks the pixels that are decided. docs/method.md, 5_shade_surfaces.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_KHR_shader_subgroup_basic : require
#extension GL_KHR_shader_subgroup_arithmetic : require
#include "shaders/drivers/if_any.glsl"
#include "shaders/shared/bindings.h"
#include "shaders/shared/frame_params.h"

layout(local_size_x_id = SPEC_GROUP) in;
#include "shaders/common/groups.glsl"
layout(constant_id = SPEC_PAYLOAD) const uint PAYLOAD = 0u;
layout(constant_id = SPEC_CREASES) const uint CREASES = 1u;
layout(constant_id = SPEC_REFINED) const uint REFINED = 0u;
layout(constant_id = SPEC_MIXED) const uint MIXED = 0u;
const uint FOOTPRINTS = PROCEDURAL, WARP = FACE, ANTIALIAS = 0u, NARROW = 1u, TRACED = 0u, NODES = 6u;
#include "shaders/common/frame.glsl"
layout(binding = BIND_VOLUME, r32f) uniform readonly image3D volume;
#include "shaders/drivers/texels.glsl"
STORED_PIXELS(BIND_PICTURE, picture, output_pixels, load_pixel, store_pixel)
TEXEL_WORDS(BIND_TILE_TODO, todo_pixels, tile_todo, load_todo)
TEXEL_WORDS(BIND_TILE_PIXELS, listed_pixels, tile_pixels, load_listed)
layout(push_constant) uniform Push { uint what; };  // as in 5_draw_tiles; round 1: only marks
ivec3 dims;
#include "shaders/splats/splat_projection.glsl"
#include "shaders/light/shading.glsl"
#include "shaders/common/labels.glsl"
#include "shaders/common/matter.glsl"

uint label_number(ivec3 p) { return imageLoad(labels, p).r; }
bool label_votes(ivec3 p, uint material) { return LABELS == LABELS_OF_SCAN ? material_of(imageLoad(volume, p).r) == material : label_number(p) > 0u; }
#include "footprints/in_float.glsl"
#include "engine/geometry/seen_label.glsl"
#include "shaders/tiles/tile_places.glsl"
#include "shaders/tiles/sheet_ways.glsl"
#include "shaders/tiles/surface_pixel.glsl"
#include "shaders/tiles/seen_surfaces.glsl"

// Payload and opacity.
vec4 seen_of(SurfaceVotes votes, vec3 u) {
    float way = max(way_to(votes), 1e-4), depth = way * dot(params.of_volume.view_z, u);
    bool begun = votes.number >= BEGUN_MATTER;
    vec3 normal = unit_or_zero(params.of_volume.normal_to_world * votes.normal);
    vec3 along = params.of_volume.index_to_world * u;
    uint material = begun ? votes.number - BEGUN_MATTER : votes.number >> 28;
    // With several materials in a body: that of the splat's own voxel.
    if (ISO_COUNT > 1u) {
        IF_ANY(!begun) {
            uint at = begun ? 0u : SplatsRef(params.of_volume.splats).at[splat_of(votes.number)].voxel;
            uint nx = uint(dims.x), ny = uint(dims.y);
            uint own = material_of(imageLoad(volume, ivec3(at % nx, at / nx % ny, at / nx / ny)).r);
            material = begun ? material : own;
        }
    }
    float chord = mean_chord(votes), opacity = 1.0 - exp(-params.of_volume.materials[material].a * length(along) * chord);
    opacity = chord < 0.999 * SURFACE_CHORD ? opacity : 1.0;
    if (PAYLOAD == PAYLOAD_NORMAL) return vec4(normal, opacity);
    if (PAYLOAD == PAYLOAD_DEPTH_DISTANCE) {
        Splat splat = SplatsRef(params.of_volume.splats).at[begun ? 0u : splat_of(votes.number)];
        return vec4(depth, begun ? 0.0 : -unpack_edge(splat.normal, splat.edge).d, 0.0, opacity);
    }
    vec3 color = params.of_volume.materials[material].rgb;
    if (LABELS != 0u) {
        uint label = seen_label(params.of_volume.anchor + params.of_volume.eye + way * u, material);
        color = label == 0u ? color : ColorsRef(params.frame.label_colors).at[label - 1u];
    }
    vec3 light = shade(Surface(color, response_of(material), lights_at(votes), dot(normal, normal) > 0.0, normal, arrives_at(votes), way * along, -normalize(along), depth));
    return vec4(light, opacity);
}

void main() {
    dims = params.of_volume.dims;
    uint item = group_number(), groups = REFINED == 1u ? what >> 20 & 0xfu : TILE * TILE / gl_WorkGroupSize.x;
    uint tile = item / groups, place = item % groups * gl_WorkGroupSize.x + gl_LocalInvocationIndex;
    if (tile >= tile_count()) return;
    ivec2 size = params.frame.size;
    uint count = REFINED == 1u ? pixels_of(tile) : TILE * TILE;
    if (item % groups * gl_WorkGroupSize.x >= count) return;
    ivec2 at = pixel_of(tile, place, count), pixel = min(at, size - 1);
    bool inside = at.x < size.x && at.y < size.y && place < count, marks = (what & 0xfffffu) == 1u, closes = false;
    uint number = uint(pixel.y * size.x + pixel.x);
    vec2 slope = slopes_of(pixel);
    vec3 u = normalize(params.of_volume.ray_z + slope.x * params.of_volume.ray_x + slope.y * params.of_volume.ray_y);
    SurfaceVotes front = load_front(pixel, inside);
    bool some = front.hits > 0.0;
    IF_ANY(some && marks) {
        SurfacePair pair = load_votes(pixel);
        bool open = load_pixel(number).a == 0.0;
        closes = some && marks && open && is_decided(pair, way_before(sheet_ways(u, votes_before()), params.frame.sheets_drawn), params.of_volume.solid);
        if (closes) store_pixel(number, vec4(0.0, 0.0, 0.0, 1.0));
    }
    if (MIXED == 1u && !marks && inside) {
        for (uint k = 0u; k < SEEN_SURFACES; ++k) keep_seen(number, k, vec4(0.0), NEVER_SEEN);
    }
    float end = 3e38;  // depth of the solid surface
    IF_ANY(some && !marks) {
        bool shades = some && !marks;
        vec4 seen = vec4(0.0);
        uint kept = 0u;
        for (int k = 0; k < 2; ++k) {
            bool there = shades && wins(front);
            IF_ANY(there) {
                vec4 next = seen_of(front, u);
                if (there) seen += (1.0 - seen.a) * next.a * vec4(next.rgb, 1.0);
                if (MIXED == 1u && there) {
                    bool solid = mean_chord(front) >= params.of_volume.solid;
                    next.a = solid ? 1.0 : next.a;
                    end = solid ? way_to(front) * dot(params.of_volume.view_z, u) : end;
                    keep_seen(number, kept++, next.a * vec4(next.rgb, 1.0), way_to(front));
                }
            }
            // Also surfaces that no later splat decided.
            shades = shades && k == 0 && !(there && mean_chord(front) >= params.of_volume.solid);
            IF_ANY(shades) {
                if (shades) front = load_surface(pixel, 3u);
            }
        }
        if (some && !marks) store_pixel(number, seen);
    }
    if (MIXED == 1u && !marks) {
        float last = subgroupMax(inside ? max(end, 0.0) : 0.0);
        if (subgroupElect()) atomicMax(UintsRef(params.frame.tile_ends).at[tile], floatBitsToUint(last));
    }
    uint closing = subgroupAdd(closes ? 1u : 0u);
    if (subgroupElect() && closing > 0u) atomicAdd(UintsRef(params.frame.tile_closed).at[tile], closing);
}
