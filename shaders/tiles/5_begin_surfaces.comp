// Before surface splats are drawn: clears each pixel's votes. Where the ray enters the volume, or what clip planes keep,
// in the matter, or begins in it at the eye, it stores a certain vote instead. docs/method/surfaces.md.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/drivers/if_any.glsl"
#include "shaders/shared/bindings.h"
#include "shaders/shared/frame_params.h"

layout(local_size_x = 256) in;
#include "shaders/common/groups.glsl"
layout(constant_id = SPEC_CLIP_KEEP) const uint CLIP_KEEP = 0u;
layout(constant_id = SPEC_CLIP_REMOVE) const uint CLIP_REMOVE = 0u;
layout(constant_id = SPEC_INNER) const uint INNER = 0u;
const uint CREASES = 0u;
#include "shaders/common/frame.glsl"
layout(binding = BIND_COEFFICIENTS, r32f) uniform readonly image3D coefficients;
layout(binding = BIND_VOLUME, r32f) uniform readonly image3D volume;
#include "shaders/drivers/texels.glsl"
ivec3 dims;
#define CLIP_PARAMS params.of_volume
#include "shaders/footprints/slice.glsl"
#include "shaders/common/clip_ray.glsl"
#include "footprints/in_float.glsl"
#include "engine/geometry/volume_ends.glsl"
#include "shaders/common/volume_sampling.glsl"
#include "shaders/common/matter.glsl"
#include "shaders/tiles/pixel_slopes.glsl"
#include "shaders/tiles/ray_parts.glsl"
#include "shaders/footprints/face_record.glsl"
#include "shaders/light/shadow.glsl"
#include "shaders/tiles/surface_pixel.glsl"

// The material at p, index space, and how far the ray along u stays in the body there. `n`: normal of the body's surface
// nearby; 0 if none is near. The field itself is evaluated only where the samples around leave a doubt.
struct BegunMatter {
    uint material;
    float chord;
    vec3 n;
};

// Whether a place, relative to the anchor, lies in a side of the rim, beyond which matter of another volume continues.
bool is_at_rim(vec3 place) {
    bool at_side = false;
    for (int i = 0; i < 6; ++i) at_side = at_side || abs(dot(params.of_volume.rim[i], vec4(place, 1.0))) < RIM_WIDTH;
    return at_side;
}
// The normal of the body's nearest surface, to its outside, from its value and gradient at a place; 0 if none is within
// SURFACE_STEP voxels.
vec3 normal_nearby(vec4 field, vec2 body) {
    float slope = length(field.xyz), up = body.y - field.w, down = field.w - body.x;
    vec3 outwards = (up < down ? field.xyz : -field.xyz) / max(slope, 1e-12);
    return min(up, down) < SURFACE_STEP * slope ? outwards : vec3(0.0);
}

BegunMatter begun_at(vec3 p, vec3 u) {
    ivec3 cell = clamp(ivec3(floor(p)), ivec3(0), dims - 1);
    float least = voxel(cell), most = least;
    for (int i = 1; i < 8; ++i) {
        float corner = voxel(min(cell + ivec3(i & 1, i >> 1 & 1, i >> 2), dims - 1));
        least = min(least, corner);
        most = max(most, corner);
    }
    float spread = most - least;
    BegunMatter begun = BegunMatter(material_of(least), SURFACE_CHORD, vec3(0.0));
    bool doubt = material_of(least - SURFACE_DOUBT * spread) != material_of(most + SURFACE_DOUBT * spread);
    IF_ANY(doubt) {
        vec4 field = bspline_slope(ivec3(0), p);
        vec2 body = body_around(field.w);
        if (doubt) {
            begun.material = material_of(field.w);
            begun.chord = chord_in_body(field.w, dot(field.xyz, u), body.x, body.y);
            if (INNER == 1u) begun.n = normal_nearby(field, body);
        }
        // Matter soon behind counts, too.
        bool thin = doubt && is_drawn(begun.material) && begun.chord < SURFACE_CHORD;
        IF_ANY(thin) {
            float chord = min(begun.chord, SURFACE_PROBE);
            for (int i = 1; i < SURFACE_PROBES; ++i) chord += is_drawn(material_of(bspline(p + (float(i) + 0.5) * SURFACE_PROBE * u))) ? SURFACE_PROBE : 0.0;
            if (thin) begun.chord = chord;
        }
    }
    return begun;
}

void begin_part(inout SurfaceVotes votes, RayPart part, vec3 from, vec3 u) {
    bool enters = part.first < part.last;
    // An eye in matter sees nothing else.
    vec3 n = part.n == vec3(0.0) ? -u : part.n;
    IF_ANY(enters) {
        vec3 at = from + part.first * u;
        BegunMatter begun = begun_at(at, u);
        // This volume's surface continues that of another volume, so the ray does not see a cut.
        if (INNER == 1u && part.n != vec3(0.0) && is_at_rim(at - params.of_volume.anchor)) n = dot(begun.n, u) < 0.0 ? begun.n : n;
        enters = enters && is_drawn(begun.material) && has_data(voxel(clamp(ivec3(round(at)), ivec3(0), dims - 1)));
        if (enters) begin_matter(votes, part.first, min(begun.chord, part.last - part.first), normalize(n), BEGUN_MATTER | begun.material);
    }
}

void main() {
    uint number = invocation_number();
    ivec2 size = params.frame.size, pixel = ivec2(number % uint(size.x), number / uint(size.x));
    if (pixel.y >= size.y) return;
    dims = params.of_volume.dims;
    vec2 slope = slopes_of(pixel);
    vec3 u = normalize(params.of_volume.ray_z + slope.x * params.of_volume.ray_x + slope.y * params.of_volume.ray_y), from = params.of_volume.anchor + params.of_volume.eye;
    RayParts parts = ray_parts(u);
    SurfacePair pair = no_surfaces();
    begin_part(pair.front, parts.before, from, u);
    if (CLIP_REMOVE > 0u) begin_part(pair.front, pair.front.hits > 0.0 ? RayPart(0.0, 0.0, vec3(0.0)) : parts.behind, from, u);
    bool begun = pair.front.hits > 0.0;
    if (!begun) forget_votes(pixel);
    IF_ANY(begun) {
        if (begun) store_votes(pixel, pair, true);
    }
}
