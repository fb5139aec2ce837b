// Keeps the first two surfaces that each ray meets in several volumes. docs/method.md, 6_merge_surfaces.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/shared/bindings.h"
#include "shaders/shared/frame_params.h"

layout(local_size_x = 64) in;
#include "shaders/common/groups.glsl"
#include "shaders/common/frame.glsl"
layout(push_constant) uniform Push { uint how; };  // passes::Merge
const uint ADD = 1u, TAKE = 2u;
#include "shaders/tiles/pixel_slopes.glsl"
#include "shaders/tiles/seen_surfaces.glsl"

struct SeenSurface {
    vec4 value;  // premultiplied payload, opacity
    float way;   // mm
};

const SeenSurface NO_SURFACE = SeenSurface(vec4(0.0), NEVER_SEEN);

SeenSurface nearest_surface(uint pixel, uint k) {
    uint at = seen_at(pixel, k);
    return SeenSurface(PixelsRef(params.frame.nearest_surfaces).at[at], FloatsRef(params.frame.nearest_ways).at[at]);
}

void keep_nearest(uint pixel, uint k, SeenSurface surface) {
    uint at = seen_at(pixel, k);
    PixelsRef(params.frame.nearest_surfaces).at[at] = surface.value;
    FloatsRef(params.frame.nearest_ways).at[at] = surface.way;
}

// A length that is no way stays what it is.
float scaled(float way, float factor) { return way >= NEVER_SEEN ? NEVER_SEEN : way * factor; }

void main() {
    uint at = invocation_number(), width = uint(params.frame.size.x);
    if (at >= width * uint(params.frame.size.y)) return;
    vec2 slope = slopes_of(ivec2(at % width, at / width));
    vec3 u = normalize(params.of_volume.ray_z + slope.x * params.of_volume.ray_x + slope.y * params.of_volume.ray_y);
    float mm = length(params.of_volume.index_to_world * u);
    if (how == TAKE) {
        for (uint k = 0u; k < SEEN_SURFACES; ++k) {
            SeenSurface surface = nearest_surface(at, k);
            keep_seen(at, k, surface.value, scaled(surface.way, 1.0 / mm));
        }
        return;
    }
    SeenSurface own = SeenSurface(seen_surface(at, 0u), scaled(seen_way(at, 0u), mm)), own_second = SeenSurface(seen_surface(at, 1u), scaled(seen_way(at, 1u), mm));
    SeenSurface other = NO_SURFACE, other_second = NO_SURFACE;
    if (how == ADD) {
        other = nearest_surface(at, 0u);
        other_second = nearest_surface(at, 1u);
    }
    bool own_first = own.way < other.way;
    SeenSurface first = other, second = own;
    if (own_first) first = own;
    if (own_first) second = other;
    if (own_first && own_second.way < other.way) second = own_second;
    if (!own_first && other_second.way <= own.way) second = other_second;
    keep_nearest(at, 0u, first);
    if (first.value.a >= 1.0) second = NO_SURFACE;
    keep_nearest(at, 1u, second);
}
