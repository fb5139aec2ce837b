// Parameters of 2b_occlude_ambient and 2c_cast_shadows besides the scene. Written before each of them.
#ifndef EDGESPLAT_LIGHT_PARAMS_H
#define EDGESPLAT_LIGHT_PARAMS_H
#include "shaders/shared/scene_params.h"
EDGESPLAT_SHARED_BEGIN

EDGESPLAT_CONSTANT uint OCCLUSION_RAYS = 48u;       // per splat and face
EDGESPLAT_CONSTANT uint OCCLUSION_STEPS = 256u;     // upper bound per ray
EDGESPLAT_CONSTANT float OCCLUSION_LIFT = 1.25f;    // voxels; from here, the nearest voxels of a ray above a plane do not lie behind the plane

struct LightParams {
    mat3 normal_to_world;   // S^-T
    float radius;           // mm, of ambient occlusion
    float iso[16];          // of the matter that attenuates light, scaled, ascending; beyond them: +3e38
    float extinction[16];   // of each of its materials, per mm
    vec4 clip_keep[8];      // normal (unit) and offset, index space: values above 0 are beyond the plane
    vec4 clip_remove[8];
    vec4 light;             // of shadows, index space: direction towards the light (w = 0) or its place (w = 1)
    uint splat_count;
    uint channel;           // of shadows: 0 or 1, the half of the splat's word; 0 is written first
    Address reach;          // (splat_count) uint: 2 x unorm16. Ambient: for the face that the normal points out of, and for the other
    // Only if the matter is that of another volume. The clip planes are in the index space of the splats' volume.
    mat3 to_matter;         // from the index space of the splats' volume
    mat3 to_splats;         // its inverse
    mat3 matter_normals;    // S^-T of the matter's volume
    vec3 matter_at;         // the splats' origin, in the matter's index space
    ivec3 matter_dims;
    Address matter_transfer;  // its transfer function
    uint cuts_splats;       // 1: the planes cut the splats' volume
    uint cuts_matter;       // 1: they cut the matter
};

EDGESPLAT_SHARED_END

#ifdef __cplusplus
static_assert(sizeof(edgesplat::shader::LightParams) == 604);
#endif
#endif
