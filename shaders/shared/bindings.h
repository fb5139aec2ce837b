// The single descriptor set. Lists are passed as device addresses. Data that all invocations read alike is in a uniform
// block: lavapipe loads it once for eight invocations, and through an address eight times.
#ifndef EDGESPLAT_BINDINGS_H
#define EDGESPLAT_BINDINGS_H
#include "shaders/shared/glue.h"
EDGESPLAT_SHARED_BEGIN

EDGESPLAT_CONSTANT uint BIND_VOLUME = 0u;        // r32f (z, y, x), samples scaled to their range
EDGESPLAT_CONSTANT uint BIND_COEFFICIENTS = 1u;  // r32f, cubic B-spline coefficients (estimator `cubic` only)
EDGESPLAT_CONSTANT uint BIND_EDGES = 2u;         // rg32ui, edge field (shared/edge.h)
EDGESPLAT_CONSTANT uint BIND_BURIED = 3u;        // r8ui, 1 = all voxels around are opaque
EDGESPLAT_CONSTANT uint BIND_PREPARED = 4u;      // rgba32f, records of a chunk's splats (splats/prepared_splat.glsl)
EDGESPLAT_CONSTANT uint BIND_LABELS = 5u;        // r32ui (z, y, x), label of each voxel from 1 on, 0: none
EDGESPLAT_CONSTANT uint BIND_SHEETS = 6u;        // sheet group, one layer per sheet: (sum tau c, sum tau)
EDGESPLAT_CONSTANT uint BIND_ACCUMULATED = 7u;   // rgba32f, premultiplied colour and alpha so far
EDGESPLAT_CONSTANT uint BIND_TABLE = 8u;         // r16f, layers of footprints (shared/footprint_table.h)
EDGESPLAT_CONSTANT uint BIND_SCENE = 9u;         // SceneParams
EDGESPLAT_CONSTANT uint BIND_FRAME = 10u;        // FrameParams
EDGESPLAT_CONSTANT uint BIND_LIGHT = 11u;        // LightParams
// Texel views of buffers that also have an address; lavapipe loads and stores texels faster.
EDGESPLAT_CONSTANT uint BIND_PICTURE = 12u;        // rgba32f, FrameParams::output_pixels
EDGESPLAT_CONSTANT uint BIND_TILE_COUNTERS = 13u;  // r32ui, FrameParams::tile_counters
EDGESPLAT_CONSTANT uint BIND_TILE_CLOSED = 14u;    // r32ui, FrameParams::tile_closed
EDGESPLAT_CONSTANT uint BIND_TILE_TODO = 15u;      // r32ui, FrameParams::tile_todo
EDGESPLAT_CONSTANT uint BIND_TILE_ENTRIES = 16u;   // rg32ui (pairs in a chunk): index into `order`, sheet; sorted by tile, sheet, number
EDGESPLAT_CONSTANT uint BIND_TILE_MARKS = 17u;     // r32ui: for each MARKED_AT_ONCE entries, a word per cell of their tile (tile_marks.glsl)
EDGESPLAT_CONSTANT uint BIND_TILE_RANGES = 18u;    // rg32ui (tiles): range of entries, half open, relative to entries_first
EDGESPLAT_CONSTANT uint BIND_TILE_ORDER = 19u;     // r32ui (tiles, then groups of their pixels): longest list first; only with rounds
EDGESPLAT_CONSTANT uint BIND_TILE_PIXELS = 20u;    // r32ui (tiles, TILE * TILE): pixels to draw, x | y << 8 in the tile; only with refined pixels
EDGESPLAT_CONSTANT uint BIND_TILE_SHEETS = 21u;    // rgba32f (size.y, size.x): partial sum of a sheet that continues in the next round; with surface splats VOTE_TEXELS for each pixel (surface_pixel.glsl)
EDGESPLAT_CONSTANT uint BIND_OUTLINES = 22u;       // r32ui (size.y, size.x): the outline that passes each pixel (outline.glsl)
EDGESPLAT_CONSTANT uint BIND_COUNT = 23u;

EDGESPLAT_SHARED_END
#endif
