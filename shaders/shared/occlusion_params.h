// Parameters of 2b_occlude_ambient besides the scene. Written when the volume, its matter or the radius changes.
#ifndef EDGESPLAT_OCCLUSION_PARAMS_H
#define EDGESPLAT_OCCLUSION_PARAMS_H
#include "shaders/shared/scene_params.h"
EDGESPLAT_SHARED_BEGIN

EDGESPLAT_CONSTANT uint OCCLUSION_RAYS = 48u;       // per splat and face
EDGESPLAT_CONSTANT uint OCCLUSION_STEPS = 256u;     // upper bound per ray
EDGESPLAT_CONSTANT float OCCLUSION_LIFT = 1.25f;    // voxels; from here, the nearest voxels of a ray above a plane do not lie behind the plane

struct OcclusionParams {
    mat3 normal_to_world;   // S^-T
    float radius;           // mm
    float extinction[16];   // of each material, per mm
    vec4 clip_keep[8];      // normal (unit) and offset, index space: values above 0 are beyond the plane
    vec4 clip_remove[8];
    uint splat_count;
    uint pad;
    Address reach;          // (splat_count) uint: 2 x unorm16, for the face that the normal points out of, and for the other
};

EDGESPLAT_SHARED_END

#ifdef __cplusplus
static_assert(sizeof(edgesplat::shader::OcclusionParams) == 376);
#endif
#endif
