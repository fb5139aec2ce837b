// What passes 3 to 7 need: camera, materials and where the frame's buffers are. Written every frame.
#ifndef EDGESPLAT_FRAME_PARAMS_H
#define EDGESPLAT_FRAME_PARAMS_H
#include "shaders/shared/footprint_params.h"
#include "shaders/shared/scene_params.h"
EDGESPLAT_SHARED_BEGIN

/// A group of consecutive sheets drawn together. `rect` is in pixels, x0 y0 x1 y1, empty when x0 >= x1.
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

struct FrameParams {
    // Positions are relative to `anchor`, the centre of the splats' box, so that a far eye costs no digits.
    vec3 anchor;     // index space, voxels
    float support;   // kernel radius R, voxels
    vec3 view_x;     // right . S : mm per index step
    float anchor_x;  // view coordinates of the anchor, mm
    vec3 view_y;     // down . S
    float anchor_y;
    vec3 view_z;  // forward . S
    float anchor_z;
    vec3 eye;  // index space relative to anchor
    float tan_half_x;
    vec3 ray_x;  // S^-1 right: index units per mm
    float tan_half_y;
    vec3 ray_y;             // S^-1 down
    float sheet_thickness;  // mm
    vec3 ray_z;             // S^-1 forward
    int sheet_base;         // first sheet that can hold a splat
    mat3 index_to_world;    // S
    mat3 normal_to_world;   // S^-T
    vec3 background;        // linear light; of two colours: in the bottom row
    float ambient;
    vec3 background_top;    // linear light: in the top row
    vec4 light_at[4];       // w = 0: world unit vector towards it; w = 1: its place relative to the eye, mm
    vec4 light_color[4];    // rgb times intensity
    vec4 materials[16];      // rgb, extinction per mm
    vec4 responses[16];      // factors on ambient, diffuse and specular light, shininess
    vec4 fog;                // rgb, density per mm
    vec4 silhouette;         // rgb, strength
    ivec3 dims;
    uint splat_count;
    ivec2 size;  // pixels
    uint sheet_count;
    uint sheets_per_group;
    uint group_count;
    float band;          // an edge further away does not matter, voxels
    float saturation;    // alpha at which a pixel takes no more
    float near_depth;    // mm: depth of the plane that rays of full-screen splats are described in
    float sheet_zero;    // mm: depth of sheet 0's near plane relative to the anchor
    float fog_start;       // mm
    float silhouette_sharpness;
    vec2 pixel;            // slopes from one sample of the picture to the next; with antialias only
    uint prepared_mask;    // slots for prepared splats less one; a power of two of them
    uint entries_first;    // where the chunk's lists begin in BIND_TILE_ENTRIES, and their marks; a multiple of MARKED_AT_ONCE
    FootprintParams footprint;
    Address splats;         // (splat_count) Splat
    Address sheets;         // (slot_count) uint: sheet of each slot's splat or SHEET_NONE
    Address counters;       // (sheet_count, SORT_BLOCKS) uint: counts, then offsets
    Address order;          // (drawn) uint: splat numbers sorted by sheet
    Address groups;         // (group_count) SheetGroup
    Address draws;          // (group_count) DrawCommand
    Address drawn;          // (3) uint: splats drawn; footprints evaluated, and those of open pixels
    Address output_pixels;  // (size.y, size.x) vec4
    Address traits;         // (splat_count) uvec2: second derivatives of its face (face_record.glsl); with faces only
    Address splat_shadows;    // (splat_count) uint: unorm16 of what reaches the splat of either light with shadows
    Address splat_occlusion;  // (splat_count) uint: unorm16 of the ambient light that reaches either face
    Address light_layers;     // (sheet_count, size.y, size.x) float, of a light's picture: optical depth so far
    uint shadow_channels;     // 4 bits per light: 0 casts no shadow, else which half of splat_shadows, from 1
    float occlusion_strength;
    vec4 clip_keep[8];      // normal (unit) and offset, index space relative to anchor: above 0 is beyond
    vec4 clip_remove[8];
    Address transfer;       // (TRANSFER_ROWS + 1) TransferRow; with a transfer function
    Address values;         // (splat_count) float: what each splat is classified by, scaled; likewise
    // Where sheets are summed tile by tile: tiles of TILE x TILE pixels, row by row, and chunks of sheets that are drawn at once.
    Address tile_rects;     // (splat_count) uvec2: tiles that a splat touches: x0 | y0 << 16, x1 | y1 << 16, half open
    Address sheet_pairs;    // (sheet_count) uint: pairs of a splat and a tile that it touches
    Address sheet_starts;   // (sheet_count + 1) uint: where each sheet begins in `order`
    Address chunks;         // (chunks) uvec2: the part of `order` that is drawn at once, half open
    Address tile_counters;  // (tiles, tile_blocks) uint: counts, then offsets
    Address tile_closed;    // (tiles) uint: pixels that take no more, of those that are drawn
    Address tile_todo;      // (tiles) uint: pixels that are drawn
    Address tile_finest;    // (tiles) uint: bits of the least width of a voxel of the splats over it, pixels; with refined pixels only
    // The others that BIND_PICTURE and what follows it are for.
    Address tile_entries;
    Address tile_marks;
    Address tile_ranges;
    Address tile_order;
    Address tile_pixels;
    Address tile_sheets;
    Address outlines;
    ivec2 tiles;
    uint tile_blocks;       // columns of the tiles' histogram
    uint sort_segment;      // slots of a block that are sorted at once
    Address batches;        // (slot_count / SPLAT_BATCH) uvec2: first splat and how many; where bricks are culled
    uint slot_count;        // splats that may show: all, or SPLAT_BATCH for each batch
    uint seen_through;      // bit m: voxels beside matter of material m carry it, too
    float table_depth;      // of the faces of BIND_TABLE: no deeper under them kernels are sampled, voxels
    uint chunk_pairs;       // of a chunk that the device plans, at most; its splats are prepared, too
    uint chunk_slots;       // chunks that it plans, at most
    vec2 traced_interval;   // where the field is matter, half open, scaled; with traced faces only, as the next two
    Address traced_rays;    // (size.y, size.x, 2) vec4: what each pixel's ray meets (traced_ray.glsl)
    Address traced_entries; // uint: which of each MARKED_AT_ONCE entries are traced
    Address footprints;     // (splat_count) uvec2: layer and rotation of each that is drawn (selected_footprint.glsl); with a table only
};

EDGESPLAT_SHARED_END

#ifdef __cplusplus
static_assert(sizeof(edgesplat::shader::SheetGroup) == 32);
static_assert(sizeof(edgesplat::shader::DrawCommand) == 20);
static_assert(offsetof(edgesplat::shader::FrameParams, index_to_world) == 128);
static_assert(offsetof(edgesplat::shader::FrameParams, materials) == 356);
static_assert(offsetof(edgesplat::shader::FrameParams, dims) == 900);
static_assert(sizeof(edgesplat::shader::FrameParams) == 1564);
#else
layout(buffer_reference, scalar, buffer_reference_align = 8) buffer GroupsRef {
    SheetGroup at[];
};
layout(buffer_reference, scalar, buffer_reference_align = 4) buffer FloatsRef {
    float at[];
};
// Of what a workgroup adds to and reads again.
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
