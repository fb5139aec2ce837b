// What passes 1 and 2 need: the scene in scaled units. Written once per change of volume, scene or edge settings.
#ifndef EDGESPLAT_SCENE_PARAMS_H
#define EDGESPLAT_SCENE_PARAMS_H
#include "shaders/shared/limits.h"
EDGESPLAT_SHARED_BEGIN

struct SceneParams {
    ivec3 dims;           // voxels that the images hold, x fastest: the volume, or a block of it with a border
    uint iso_count;       // 1..15
    float iso[16];        // J_j, scaled, ascending; beyond iso_count: +3e38
    uint visible_mask;    // bit m: material m has extinction > 0
    uint opaque_mask;     // bit m: material m hides what lies bury_distance voxels behind its surface
    int bury_distance;    // voxels
    float band;           // an edge further away does not matter, voxels
    Address run_offsets;  // (runs) uint: splats of each run, then where it writes
    Address splats;       // (splat_count) Splat
    Address traits;       // (splat_count) uvec2: second derivatives of its face (face_record.glsl); with faces only
    uint seen_through;    // bit m: voxels beside matter of material m carry it, too
    uint estimate_mask;   // bit m: edges of material m are estimated
    float reach;          // no kernel reaches further, voxels
    vec4 clip_keep[8];    // normal (unit) and offset, index space: above 0 is beyond; where buried voxels are found
    vec4 clip_remove[8];
    Address transfer;      // (TRANSFER_ROWS + 1) TransferRow; with a transfer function
    Address values;        // (splat_count) float: what each splat is classified by, scaled; likewise
    ivec3 core_low;          // first voxel that becomes a splat
    ivec3 core_size;         // how many do, along each axis
    ivec3 block_origin;      // of the images' first voxel in the volume
    ivec3 volume_dims;       // voxels of the volume: Splat::voxel counts them
    uint list_first;         // first of the splats that 2a_finish_splats is to finish
    uint list_count;
    uint edge_count_at;      // where in run_offsets stands how many of them have an edge
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
EDGESPLAT_CONSTANT uint EDGE_BORDER = 1u << 28;   // in the edge field only: the volume ends there

EDGESPLAT_SHARED_END

#ifdef __cplusplus
static_assert(sizeof(edgesplat::shader::SceneParams) == 464);
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
