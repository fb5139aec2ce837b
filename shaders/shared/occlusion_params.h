// What 2b_occlude_ambient needs beside the scene. Written when the volume, the matter in it or the radius changes.
#ifndef EDGESPLAT_OCCLUSION_PARAMS_H
#define EDGESPLAT_OCCLUSION_PARAMS_H
#include "shaders/shared/scene_params.h"
EDGESPLAT_SHARED_BEGIN

EDGESPLAT_CONSTANT uint OCCLUSION_RAYS = 48u;       // per splat and face
EDGESPLAT_CONSTANT uint OCCLUSION_STEPS = 256u;     // of a ray, at most
EDGESPLAT_CONSTANT float OCCLUSION_LIFT = 1.25f;    // voxels: no voxel nearest to a ray over a plane lies behind the plane

struct OcclusionParams {
    mat3 normal_to_world;   // S^-T
    float radius;           // mm
    float extinction[16];   // of the materials, per mm
    vec4 clip_keep[8];      // normal (unit) and offset, index space: above 0 is beyond
    vec4 clip_remove[8];
    uint splat_count;
    uint pad;
    Address reach;          // (splat_count) uint: unorm16 of the face that the normal looks out of, and of the other
};

EDGESPLAT_SHARED_END

#ifdef __cplusplus
static_assert(sizeof(edgesplat::shader::OcclusionParams) == 376);
#endif
#endif
