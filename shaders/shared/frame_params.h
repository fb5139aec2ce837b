// Parameters of passes 3 to 7: camera, effects, volumes, addresses of the frame's buffers. Written every frame.
#ifndef EDGESPLAT_FRAME_PARAMS_H
#define EDGESPLAT_FRAME_PARAMS_H
#include "shaders/shared/footprint_params.h"
#include "shaders/shared/scene_params.h"
EDGESPLAT_SHARED_BEGIN

/// A group of consecutive sheets that are drawn together. `rect`: pixels, x0 y0 x1 y1; empty if x0 >= x1.
struct SheetGroup {
    uint first;  // into `order`
    uint count;  // splats
    ivec2 pad;
    ivec4 rect;
};

/// VkDrawIndexedIndirectCommand.
struct DrawCommand {
    uint index_count, instance_count, first_index;
    int vertex_offset;
    uint first_instance;
};

/// A volume whose splats are drawn: its grid as seen from the eye, its matter, its lists.
struct VolumeParams {
    // Positions are relative to `anchor`, the centre of the splats' box, so that a far eye costs no precision.
    vec3 anchor;     // index space, voxels
    float support;   // kernel radius R, voxels
    vec3 view_x;     // right . S : mm per index step
    float anchor_x;  // view coordinates of the anchor, mm
    vec3 view_y;     // down . S
    float anchor_y;
    vec3 view_z;  // forward . S
    float anchor_z;
    vec3 eye;  // index space relative to anchor
    float sheet_zero;  // mm: depth of sheet 0's near plane relative to the anchor
    vec3 ray_x;        // S^-1 right: index units per mm
    float near_depth;  // mm: depth of the plane in which rays of full-screen splats are described
    vec3 ray_y;        // S^-1 down
    float band;        // edges further away are ignored, voxels
    vec3 ray_z;        // S^-1 forward
    float table_depth;     // depth m of the faces in BIND_TABLE, voxels: points nearer to the face are moved to this depth
    mat3 index_to_world;   // S
    mat3 normal_to_world;  // S^-T
    ivec3 dims;
    uint translucent_mask;  // bit m: voxels beside matter of material m also carry it
    vec4 materials[16];     // rgb, extinction per mm
    vec4 responses[16];     // factors on ambient, diffuse and specular light, shininess
    vec4 clip_keep[8];      // normal (unit) and offset, index space relative to anchor: values above 0 are beyond the plane
    vec4 clip_remove[8];
    Address splats;           // (splats of the volume) Splat
    Address traits;           // (splats) uvec2: second derivatives of the face (face_record.glsl); only with faces
    Address splat_shadows;    // (splats) uint: 2 x unorm16, the share of each of the two lights with shadows that reaches the splat
    Address splat_occlusion;  // (splats) uint: 2 x unorm16, the share of ambient light that reaches each face
    Address values;           // (splats) float: classified value of each splat, scaled; only with a transfer function
    Address labels;           // (splats) uint: label of each splat from 1 on, 0: none; only with labels
    Address transfer;         // (TRANSFER_ROWS + 1) TransferRow; only with a transfer function
    // Only if kernels of several volumes are drawn as one list: where the volume's splats and label colours begin in it,
    // and what its kernels have of what some volume's have.
    uint first_splat;
    uint first_label;
    uint has_transfer;
    uint has_labels;
    uint lit_edges;
    // Only with a rim (rim.glsl). Planes whose value at a place relative to the anchor rises from 0 at the rim's outside
    // to 1 at its inside; of surfaces, the distance to the side, voxels. 1: this is the volume within.
    uint rim_within;
    vec4 rim[6];
    // Only with surface splats.
    uint visible_mask;  // bit m: material m is matter
    float solid;        // voxels of matter along a ray behind which nothing is seen
    float iso[16];      // the scene's iso-values, scaled, ascending; beyond them: +3e38
};

struct FrameParams {
    float tan_half_x;
    float tan_half_y;
    float sheet_thickness;  // mm
    int sheet_base;         // first sheet that can contain a splat
    vec3 background;        // linear light; of a gradient: in the bottom row
    float ambient;
    vec3 background_top;    // linear light: in the top row
    vec4 light_at[4];       // w = 0: world unit vector towards the light; w = 1: its position relative to the eye, mm
    vec4 light_color[4];    // rgb times intensity
    vec4 fog;                // rgb, density per mm
    vec4 silhouette;         // rgb, strength
    uint splat_count;
    ivec2 size;  // pixels
    uint sheet_count;
    uint sheets_per_group;
    uint group_count;
    float saturation;    // alpha from which on a pixel is saturated
    float fog_start;       // mm
    float silhouette_sharpness;
    vec2 pixel;            // slope difference of adjacent samples; only with antialias
    uint prepared_mask;    // number of slots for prepared splats, a power of two, minus 1
    uint entries_first;    // where the chunk's lists, and their marks, begin in BIND_TILE_ENTRIES; a multiple of MARKED_AT_ONCE
    FootprintParams footprint;
    Address sheets;         // (slot_count) uint: sheet of each slot's splat, or SHEET_NONE
    Address counters;       // (sheet_count, SORT_BLOCKS) uint: counts, then offsets
    Address order;          // (drawn) uint: splat numbers sorted by sheet
    Address groups;         // (group_count) SheetGroup
    Address draws;          // (group_count) DrawCommand
    Address drawn;          // (3) uint: splats drawn; footprints evaluated, in total and for unsaturated pixels
    Address output_pixels;  // (size.y, size.x) vec4
    uint shadow_channels;     // 4 bits per light: 0: no shadow, else the half of splat_shadows, counted from 1
    float occlusion_strength;
    Address label_colors;   // (labels) vec3, linear light; only with labels
    // Only if sheets are summed tile by tile: tiles of TILE x TILE pixels, row by row, and chunks of sheets that are
    // drawn together.
    Address tile_rects;     // (splat_count) uvec2: tiles that a splat touches: x0 | y0 << 16, x1 | y1 << 16, half open
    Address sheet_pairs;    // (sheet_count) uint: number of pairs of a splat and a tile that it touches
    Address sheet_starts;   // (sheet_count + 1) uint: where each sheet begins in `order`
    Address chunks;         // (chunks) uvec2: ranges of `order` that are drawn together, half open
    Address tile_counters;  // (tiles, tile_blocks) uint: counts, then offsets
    Address tile_closed;    // (tiles) uint: saturated pixels among those to draw
    Address tile_todo;      // (tiles) uint: pixels to draw
    Address tile_finest;    // (tiles) uint: float bits of the smallest voxel width, pixels, of the splats over it; only with refined pixels
    // Addresses of the other buffers from BIND_PICTURE on.
    Address tile_entries;
    Address tile_marks;
    Address tile_ranges;
    Address tile_order;
    Address tile_pixels;
    Address tile_sheets;
    Address outlines;
    ivec2 tiles;
    uint tile_blocks;       // columns of the tile histogram
    uint sort_segment;      // slots of a block that one dispatch sorts
    Address batches;        // (slot_count / SPLAT_BATCH) uvec2: first splat and count; only if bricks are culled
    uint slot_count;        // splat slots: all splats, or SPLAT_BATCH for each batch
    uint chunk_pairs;       // upper bound of pairs in a chunk that the device plans, and of its prepared splats
    uint chunk_slots;       // upper bound of chunks that the device plans
    Address traced_rays;    // (size.y, size.x, 2) vec4: what each pixel's ray meets (traced_ray.glsl); this and the next only if rays search
    Address traced_entries; // uint: a bit for each of MARKED_AT_ONCE entries: it is traced
    uint volume_count;      // volumes whose kernels are drawn as one list
    Address footprints;     // (splat_count) uvec2: layer and rotation of each drawn splat (selected_footprint.glsl); only with a table
    // Only with surface splats, from here on.
    uint sheets_drawn;      // after this part of the picture, all splats in front of this sheet are drawn
    // Only if kernels draw translucent matter in front of those surfaces, or of several volumes (seen_surfaces.glsl).
    Address seen_surfaces;  // (2, size.y, size.x) vec4: first and second surface of each pixel: premultiplied payload, opacity
    Address seen_ways;      // (2, size.y, size.x) float: distance to it along the ray, voxels
    Address surfaces_passed;  // (size.y, size.x) uint: how many of them are in the picture so far
    Address tile_ends;      // (tiles) uint: float bits of the depth (mm) at which the last of a tile's rays ends at a solid surface; infinity: not all end
    // Only with several volumes: the same of all volumes drawn so far.
    Address nearest_surfaces;  // (2, size.y, size.x) vec4
    Address nearest_ways;      // (2, size.y, size.x) float, mm
};

/// What BIND_FRAME holds: volumes[0], and those whose kernels are drawn with its kernels as one list.
struct FrameBlock {
    FrameParams frame;
    VolumeParams volumes[MAX_TOGETHER];
};

EDGESPLAT_SHARED_END

#ifdef __cplusplus
static_assert(sizeof(edgesplat::shader::SheetGroup) == 32);
static_assert(sizeof(edgesplat::shader::DrawCommand) == 20);
static_assert(offsetof(edgesplat::shader::VolumeParams, index_to_world) == 128);
static_assert(offsetof(edgesplat::shader::VolumeParams, materials) == 216);
static_assert(sizeof(edgesplat::shader::VolumeParams) == 1232);
static_assert(offsetof(edgesplat::shader::FrameParams, size) == 208);
static_assert(sizeof(edgesplat::shader::FrameParams) == 580);
static_assert(offsetof(edgesplat::shader::FrameBlock, volumes) == sizeof(edgesplat::shader::FrameParams));
// Every device allows so large a uniform block.
static_assert(sizeof(edgesplat::shader::FrameBlock) <= 16384);
#else
layout(buffer_reference, scalar, buffer_reference_align = 8) buffer GroupsRef {
    SheetGroup at[];
};
layout(buffer_reference, scalar, buffer_reference_align = 4) buffer FloatsRef {
    float at[];
};
layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer ColorsRef {
    vec3 at[];
};
// Coherent: a workgroup reads counters that it has changed.
layout(buffer_reference, scalar, buffer_reference_align = 4) coherent buffer CountersRef {
    uint at[];
};
layout(buffer_reference, scalar, buffer_reference_align = 8) buffer PairsRef {
    uvec2 at[];
};
layout(buffer_reference, scalar, buffer_reference_align = 4) buffer DrawsRef {
    DrawCommand at[];
};
layout(buffer_reference, scalar, buffer_reference_align = 16) buffer PixelsRef {
    vec4 at[];
};
#endif
#endif
