// The share of ambient light that reaches a splat: traces rays over the half space that its normal points into, with
// nearest-voxel lookup. docs/method.md, 2b_occlude_ambient.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/shared/bindings.h"
#include "shaders/shared/light_params.h"

layout(local_size_x = 64) in;
#include "shaders/common/groups.glsl"
layout(constant_id = SPEC_CLIP_KEEP) const uint CLIP_KEEP = 0u;      // number of planes
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
#include "footprints/in_float.glsl"
#include "engine/geometry/light_ray.glsl"

// Cosine and sine of the golden angle: successive points of Vogel's spiral (1979).
const vec2 GOLDEN = vec2(-0.7373688780783197, 0.6754902942615238);

// Transmittance exp(-tau) over `radius` mm from `start` (index space) along `u` (index units per mm).
float transmittance(vec3 start, vec3 u) {
    float radius = light.at.radius;
    // The 0.01 absorbs rounding: if the radius is a whole number of voxels, `steps` is that number.
    int steps = int(clamp(ceil(radius * length(u) - 0.01), 1.0, float(OCCLUSION_STEPS)));
    float dl = radius / float(steps);
    // The part of the ray inside the volume's cells, in steps.
    ivec3 dims = matter_dims();
    VolumeEnds ends = volume_ends(start, divisible(u) * dl, dims);
    int first = int(ceil(clamp(entry_of(ends) - 0.5, 0.0, 1e6))), last = min(int(ceil(clamp(exit_of(ends) - 0.5, 0.0, 1e6))), steps);
    float tau = 0.0;
    for (int i = first; i < last && tau < DARK; ++i) {
        vec3 p = start + (float(i) + 0.5) * dl * u;
        ivec3 nearest = clamp(ivec3(floor(p + 0.5)), ivec3(0), dims - 1);
        tau += dl * extinction_of(imageLoad(volume, nearest).r, vec3(nearest));
    }
    return exp(-tau);
}

void main() {
    uint i = invocation_number();
    if (i >= light.at.splat_count) return;
    Splat splat = SplatsRef(params.scene.splats).at[i];
    Edge e = unpack_edge(splat.normal, splat.edge);
    // Their second distance is an error, and planes cut rays, not splats.
    if (SURFACES == 1u) e.d2 = 1e9;
    uint nx = uint(params.scene.dims.x), ny = uint(params.scene.dims.y);
    uvec3 voxel = uvec3(splat.voxel % nx, splat.voxel / nx % ny, splat.voxel / nx / ny);
    // Neighbouring voxels use rotated directions that fill each other's gaps: the 3-D additive sequence of the plastic
    // number.
    uint turn = voxel.x * 3518319155u + voxel.y * 2882110345u + voxel.z * 2360945575u;
    float phase = float(turn >> 8u) * (6.28318531 / 16777216.0);

    mat3 to_index = world_to_matter();
    vec2 reach = vec2(0.0);
    int faces = is_wall(e, params.scene.band) ? 2 : 1;
    for (int face = 0; face < faces; ++face) {
        SurfacePoint s = surface_point(e, params.scene.band, face == 1, light.at.normal_to_world);
        if (SURFACES == 0u && planes_cut_splats()) s = at_cut(s, e, vec3(voxel), light.at.normal_to_world);
        bool sphere = s.normal == vec3(0.0);
        vec3 start = in_matter(vec3(voxel) + s.foot + min(OCCLUSION_LIFT * s.voxel, s.room) * s.step);
        mat3 frame = sphere ? mat3(1.0) : frame_of(s.normal);
        vec2 round = vec2(cos(phase), sin(phase));
        float sum = 0.0;
        for (uint k = 0u; k < OCCLUSION_RAYS; ++k) {
            // Equal shares of the cosine over the half space (a spiral on the disc below it), or of the whole sphere.
            float share = (float(k) + 0.5) / float(OCCLUSION_RAYS);
            float up = sphere ? 1.0 - 2.0 * share : sqrt(1.0 - share);
            vec3 direction = frame * vec3(sqrt(1.0 - up * up) * round, up);
            sum += transmittance(start, to_index * direction);
            round = vec2(round.x * GOLDEN.x - round.y * GOLDEN.y, round.x * GOLDEN.y + round.y * GOLDEN.x);
        }
        if (face == 0) reach = vec2(sum / float(OCCLUSION_RAYS));
        else reach.y = sum / float(OCCLUSION_RAYS);
    }
    uint before = 0u;
    if (BESIDE == 1u) before = UintsRef(light.at.reach).at[i];
    UintsRef(light.at.reach).at[i] = kept_share(packUnorm2x16(reach), before);
}
