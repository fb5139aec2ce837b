// Parameters of the ray caster besides the scene: camera, materials, light. Written every frame.
#ifndef EDGESPLAT_RAYCAST_PARAMS_H
#define EDGESPLAT_RAYCAST_PARAMS_H
#include "shaders/shared/frame_params.h"
EDGESPLAT_SHARED_BEGIN

// The ray caster has its own descriptor set with the common layout. Three slots contain other data there.
EDGESPLAT_CONSTANT uint BIND_BRICKS = 3u;         // r8ui (z, y, x): distance in bricks to the nearest one that is not transparent
EDGESPLAT_CONSTANT uint BIND_BRICK_SCRATCH = 4u;  // r8ui: intermediate distances

EDGESPLAT_CONSTANT uint BIND_RAYS = 10u;         // RaycastBlock

EDGESPLAT_CONSTANT uint BRICK_SHIFT = 2u;  // bricks of 4^3 voxels: fastest on lavapipe, 8^3 takes 5-13 % longer
EDGESPLAT_CONSTANT uint BRICK_FAR = 255u;  // sentinel for larger distances between bricks

EDGESPLAT_CONSTANT uint FILTER_TRILINEAR = 0u, FILTER_CUBIC = 1u;

EDGESPLAT_CONSTANT float BORDER_LIGHT = 1.0f;  // voxels from the volume's border within which its normal lights matter of a transfer function

struct RayParams {
    // Rays begin on the plane across the view through `anchor`, the centre of the volume: a far eye costs no precision.
    vec3 anchor;          // index space
    float anchor_x;       // view coordinates of the anchor, mm: right, down, forward of the eye
    vec3 ray_x;           // S^-1 right: index units per mm
    float anchor_y;
    vec3 ray_y;           // S^-1 down
    float anchor_z;
    vec3 ray_z;           // S^-1 forward
    float tan_half_x;
    mat3 index_to_world;  // S
    mat3 normal_to_world; // S^-T
    vec3 light;           // world unit vector towards the light (Directional)
    float tan_half_y;
    vec3 background;      // linear light
    float ambient;
    vec4 materials[16];   // rgb, extinction per mm
    ivec2 size;           // pixels
    float diffuse;
    float saturation;     // alpha at which a ray ends
    float step;           // voxels
    float pad;
    Address pixels;       // (size.y, size.x) vec4
    Address label_colors; // (labels) vec3, linear light; only with labels
};

#ifdef __cplusplus
/// The uniform block of the ray caster.
struct RaycastBlock {
    SceneParams scene;
    RayParams rays;
};
#endif

EDGESPLAT_SHARED_END

#ifdef __cplusplus
static_assert(offsetof(edgesplat::shader::RayParams, index_to_world) == 64);
static_assert(offsetof(edgesplat::shader::RayParams, materials) == 168);
static_assert(sizeof(edgesplat::shader::RayParams) == 464);
#endif
#endif
