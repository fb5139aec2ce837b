// From the swept optical depths: the share of the light that reaches each splat in the light's picture. docs/method.md,
// 2d_shadow_splats.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/shared/bindings.h"
#include "shaders/shared/frame_params.h"

layout(local_size_x = 64) in;
#include "shaders/common/groups.glsl"
layout(constant_id = SPEC_CLIP_KEEP) const uint CLIP_KEEP = 0u;
layout(constant_id = SPEC_CLIP_REMOVE) const uint CLIP_REMOVE = 0u;
layout(binding = BIND_FRAME, scalar) uniform Frame { FrameParams frame; } params;
layout(push_constant) uniform Push {
    uint channel;  // 0 or 1: the half of the splat's word to write
};
#define CLIP_PARAMS params.frame
#include "shaders/light/surface_point.glsl"

const float LONGEST_LIFT = 8.0;      // voxels; with coarser pictures of the light a surface may shadow itself
const float SMALLEST_COSINE = 0.05;  // lower bound, for grazing light

// Optical depth from the light at `depth`, measured in sheets: linear between the far planes of the sheets.
float optical_depth(ivec2 pixel, float depth) {
    FloatsRef layers = FloatsRef(params.frame.light_layers);
    ivec2 size = params.frame.size;
    int sheet = clamp(int(floor(depth)), 0, int(params.frame.sheet_count) - 1);
    int at = (sheet * size.y + pixel.y) * size.x + pixel.x;
    float far = layers.at[at];
    float near = sheet == 0 ? 0.0 : layers.at[max(at - size.x * size.y, 0)];
    return mix(near, far, clamp(depth - float(sheet), 0.0, 1.0));
}

void main() {
    uint i = invocation_number();
    if (i >= params.frame.splat_count) return;
    Splat splat = SplatsRef(params.frame.splats).at[i];
    Edge e = unpack_edge(splat.normal, splat.edge);
    uint nx = uint(params.frame.dims.x), ny = uint(params.frame.dims.y);
    vec3 position = vec3(splat.voxel % nx, splat.voxel / nx % ny, splat.voxel / nx / ny) - params.frame.anchor;

    vec3 to_light = normalize(params.frame.index_to_world * (params.frame.eye - position));
    SurfacePoint s = surface_point(e, params.frame.band, false, params.frame.normal_to_world);
    // Only the face of a wall that the light sees can be lit.
    if (is_wall(e, params.frame.band) && dot(s.normal, to_light) < 0.0)
        s = surface_point(e, params.frame.band, true, params.frame.normal_to_world);
    if (CLIP_KEEP + CLIP_REMOVE > 0u) s = at_cut(s, e, position, params.frame.normal_to_world);

    vec3 size_z = vec3(vec2(params.frame.size), params.frame.sheet_thickness);
    float cosine = dot(s.normal, to_light);
    float depth_here = dot(params.frame.view_z, position) + params.frame.anchor_z;
    float pixel_mm = 2.0 * params.frame.tan_half_x * max(depth_here, 0.0) / size_z.x;
    // At a slant, the neighbouring pixels look deeper below the surface by this amount.
    float slant = pixel_mm * sqrt(max(1.0 - cosine * cosine, 0.0));
    float lift = min(clamp(slant + 0.5 * s.voxel, SHORTEST_LIFT * s.voxel, LONGEST_LIFT * s.voxel), s.room);
    position += s.foot + lift * s.step;

    // The far plane that is used must not lie behind the surface.
    float ahead = s.normal == vec3(0.0) ? 0.0 : max(size_z.z - lift / max(cosine, SMALLEST_COSINE), 0.0);
    float along = dot(params.frame.view_z, position);
    float depth = (along - params.frame.sheet_zero - ahead) / params.frame.sheet_thickness;
    vec2 view = vec2(dot(params.frame.view_x, position) + params.frame.anchor_x,
                     dot(params.frame.view_y, position) + params.frame.anchor_y);
    vec2 ndc = view / ((along + params.frame.anchor_z) * vec2(params.frame.tan_half_x, params.frame.tan_half_y));
    if (!(along + params.frame.anchor_z > 0.0 && all(lessThanEqual(abs(ndc), vec2(1.0))))) return;

    vec2 pixel = (0.5 + 0.5 * ndc) * size_z.xy - 0.5;
    ivec2 last = params.frame.size - 1;
    ivec2 low = clamp(ivec2(floor(pixel)), ivec2(0), last), high = min(low + 1, last);
    vec2 t = clamp(pixel - vec2(low), 0.0, 1.0);
    vec4 reach = exp(-vec4(optical_depth(low, depth), optical_depth(ivec2(high.x, low.y), depth),
                           optical_depth(ivec2(low.x, high.y), depth), optical_depth(high, depth)));
    vec2 rows = mix(reach.xz, reach.yw, t.x);
    uint code = packUnorm2x16(vec2(mix(rows.x, rows.y, t.y)));
    UintsRef shadows = UintsRef(params.frame.splat_shadows);
    uint mask = channel == 0u ? 0xffffu : 0xffff0000u;
    shadows.at[i] = (shadows.at[i] & ~mask) | (code & mask);
}
