// The share of a light that reaches each splat: rays from its surface to the light, through the interpolated field.
// docs/method/light.md.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/shared/bindings.h"
#include "shaders/shared/light_params.h"

layout(local_size_x = 64) in;
#include "shaders/common/groups.glsl"
layout(constant_id = SPEC_CLIP_KEEP) const uint CLIP_KEEP = 0u;  // number of planes
layout(constant_id = SPEC_CLIP_REMOVE) const uint CLIP_REMOVE = 0u;
layout(constant_id = SPEC_TRANSFER) const uint TRANSFER = 0u;
layout(constant_id = SPEC_SURFACES) const uint SURFACES = 0u;
layout(constant_id = SPEC_BESIDE) const uint BESIDE = 0u;
layout(binding = BIND_VOLUME, r32f) uniform readonly image3D volume;
layout(binding = BIND_SCENE, scalar) uniform Scene { SceneParams scene; } params;
layout(binding = BIND_LIGHT, scalar) uniform Light { LightParams at; } light;
#define CLIP_PARAMS light.at
#include "shaders/edges/edge_record.glsl"
#include "shaders/light/extinction.glsl"
#include "engine/geometry/surface_point.glsl"
ivec3 dims;
#include "shaders/common/trilinear.glsl"
#include "footprints/in_float.glsl"
#include "engine/geometry/light_ray.glsl"

// Transmittance exp(-tau) along the ray; `mm`: length of a step.
float transmittance(LightRay ray, float mm) {
    float tau = 0.0;
    for (int k = ray.first; k < ray.last && tau < DARK; ++k) {
        vec3 p = ray.start + float(k) * ray.step;
        float nearest = voxel(clamp(ivec3(floor(p + 0.5)), ivec3(0), dims - 1)), value = trilinear(ivec3(0), p);
        tau += mm * extinction_of(has_data(nearest) ? max(value, 0.0) : nearest, p);
    }
    return exp(-tau);
}

void main() {
    uint i = invocation_number();
    if (i >= light.at.splat_count) return;
    dims = matter_dims();
    Splat splat = SplatsRef(params.scene.splats).at[i];
    Edge e = unpack_edge(splat.normal, splat.edge);
    // Their second distance is an error, and planes cut rays, not splats.
    if (SURFACES == 1u) e.d2 = 1e9;
    uint nx = uint(params.scene.dims.x), ny = uint(params.scene.dims.y);
    vec3 position = vec3(splat.voxel % nx, splat.voxel / nx % ny, splat.voxel / nx / ny);
    mat3 to_index = transpose(light.at.normal_to_world), to_world = inverse(to_index);

    vec3 towards = normalize(to_world * (light.at.light.xyz - light.at.light.w * position));
    SurfacePoint s = surface_point(e, params.scene.band, false, light.at.normal_to_world);
    // Only the face of a wall that the light sees can be lit.
    if (is_wall(e, params.scene.band) && dot(s.normal, towards) < 0.0) s = surface_point(e, params.scene.band, true, light.at.normal_to_world);
    if (SURFACES == 0u && planes_cut_splats()) s = at_cut(s, e, position, light.at.normal_to_world);
    vec3 from = position + s.foot + min(SHADOW_LIFT * s.voxel, s.room) * s.step;

    vec3 way = light.at.light.xyz - light.at.light.w * from;
    if (BESIDE == 1u) {
        way = light.at.to_matter * way;
        from = in_matter(from);
        to_world = inverse(world_to_matter());
    }
    float way_length = length(way);
    vec3 u = way_length > 0.0 ? way / way_length : vec3(0.0, 0.0, 1.0);
    float mm = SHADOW_STEP * length(to_world * u), reach = 0.0;
    for (int k = 0; k < SHADOW_RAYS; ++k) reach += transmittance(light_ray(from, u, light.at.light.w == 0.0 ? 1e9 : way_length, k, dims), mm);
    uint code = packUnorm2x16(vec2(reach / float(SHADOW_RAYS)));
    // The first light writes both halves, the second its own.
    if (BESIDE == 1u || light.at.channel == 1u) {
        uint before = UintsRef(light.at.reach).at[i], shared_code = kept_share(code, before);
        code = bitfieldInsert(before, shared_code >> 16 * light.at.channel, int(16u * light.at.channel), 16);
    }
    UintsRef(light.at.reach).at[i] = code;
}
