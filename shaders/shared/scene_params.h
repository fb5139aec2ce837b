// Parameters of passes 1 and 2: the scene in scaled units. Written when the volume, the scene or edge settings change.
#ifndef EDGESPLAT_SCENE_PARAMS_H
#define EDGESPLAT_SCENE_PARAMS_H
#include "shaders/shared/limits.h"
EDGESPLAT_SHARED_BEGIN

struct SceneParams {
    ivec3 dims;           // voxels in the images, x fastest: the volume, or a block of it with a border
    uint iso_count;       // 1..15
    float iso[16];        // J_j, scaled, ascending; beyond iso_count: +3e38
    uint visible_mask;    // bit m: material m has extinction > 0
    uint opaque_mask;     // bit m: material m of opaque_iso occludes everything bury_distance voxels behind its surface
    int bury_distance;    // voxels
    float band;           // edges further away are ignored, voxels
    Address run_offsets;  // (runs) uint: number of splats of each run, then its write position
    Address splats;       // (splat_count) Splat
    Address traits;       // (splat_count) uvec2: second derivatives of the face (face_record.glsl); only with faces
    uint translucent_mask; // bit m: voxels beside matter of material m also carry it
    uint estimate_mask;   // bit m: edges of material m are estimated
    float reach;          // upper bound of every kernel's reach, voxels
    vec4 clip_keep[8];    // normal (unit) and offset, index space: values above 0 are beyond the plane; for buried voxels
    vec4 clip_remove[8];
    Address transfer;      // (TRANSFER_ROWS + 1) TransferRow; only with a transfer function
    Address values;        // (splat_count) float: classified value of each splat, scaled; only with a transfer function
    Address labels;        // (splat_count) uint: label of each splat from 1 on, 0: none; only with labels
    Address bricks;        // (brick_count) uint: numbers of bricks of the images, x fastest, with BRICK_ENDS
    ivec3 core_low;          // first voxel that becomes a splat
    ivec3 core_size;         // number of these voxels along each axis
    ivec3 block_origin;      // position of the images' first voxel in the volume
    ivec3 volume_dims;       // voxels of the volume; Splat::voxel is an index into it
    uint list_first;         // first splat that 2a_finish_splats finishes
    uint list_count;
    uint edge_count_at;      // index in run_offsets of the number of splats with an edge
    uint brick_count;        // 0: all bricks
    float noise;             // standard deviation of the samples' noise, scaled; only with surface splats
    uint opaque_count;       // number of the following values
    float opaque_iso[16];    // like iso, of all matter: kernels of a mixture are collected for its translucent matter only
};

/// One splat as collected: 12 bytes.
struct Splat {
    uint voxel;   // linear index, x fastest
    uint normal;  // n, octahedral, 2 x snorm16
    uint edge;    // bits 0-15 D, 16-25 D2, 26-27 EdgeState, 28-31 material
};

// EdgeState
EDGESPLAT_CONSTANT uint EDGE_NONE = 0u;           // neither edge nor normal
EDGESPLAT_CONSTANT uint EDGE_NORMAL = 1u;         // a normal for light, no edge
EDGESPLAT_CONSTANT uint EDGE_LOWER = 2u;          // edge at the lower end of the voxel's interval: the voxel is inside
EDGESPLAT_CONSTANT uint EDGE_UPPER = 3u;          // edge at the upper end: the voxel is outside
EDGESPLAT_CONSTANT uint EDGE_BORDER = 1u << 28;   // in the edge field only: the volume's border

EDGESPLAT_SHARED_END

#ifdef __cplusplus
static_assert(sizeof(edgesplat::shader::SceneParams) == 556);
static_assert(offsetof(edgesplat::shader::SceneParams, visible_mask) == 80);
static_assert(offsetof(edgesplat::shader::SceneParams, run_offsets) == 96);
static_assert(sizeof(edgesplat::shader::Splat) == 12);
#else
layout(buffer_reference, scalar, buffer_reference_align = 4) buffer UintsRef {
    uint at[];
};
layout(buffer_reference, scalar, buffer_reference_align = 8) buffer BendingsRef {
    uvec2 at[];
};
layout(buffer_reference, scalar, buffer_reference_align = 4) buffer SplatsRef {
    Splat at[];
};
#endif
#endif
