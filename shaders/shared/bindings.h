// The one descriptor set. Lists travel as device addresses; what every invocation reads alike is a uniform block, which
// lavapipe loads once for eight of them (through an address: eight times).
#ifndef EDGESPLAT_BINDINGS_H
#define EDGESPLAT_BINDINGS_H
#include "shaders/shared/glue.h"
EDGESPLAT_SHARED_BEGIN

EDGESPLAT_CONSTANT uint BIND_VOLUME = 0u;        // r32f (z, y, x), samples scaled to their range
EDGESPLAT_CONSTANT uint BIND_COEFFICIENTS = 1u;  // r32f, cubic B-spline coefficients (estimator `cubic` only)
EDGESPLAT_CONSTANT uint BIND_EDGES = 2u;         // rg32ui, edge field (shared/edge.h)
EDGESPLAT_CONSTANT uint BIND_BURIED = 3u;        // r8ui, 1 = every voxel around is opaque
EDGESPLAT_CONSTANT uint BIND_PREPARED = 4u;      // rgba32f, records of a chunk's splats (splats/prepared_splat.glsl)
EDGESPLAT_CONSTANT uint BIND_SHEETS = 5u;        // sheet group, one layer per sheet: (sum tau c, sum tau)
EDGESPLAT_CONSTANT uint BIND_ACCUMULATED = 6u;   // rgba32f, premultiplied colour and alpha so far
EDGESPLAT_CONSTANT uint BIND_TABLE = 7u;         // r16f, layers of footprints (shared/footprint_table.h)
EDGESPLAT_CONSTANT uint BIND_SCENE = 8u;         // SceneParams
EDGESPLAT_CONSTANT uint BIND_FRAME = 9u;         // FrameParams
EDGESPLAT_CONSTANT uint BIND_OCCLUSION = 10u;    // OcclusionParams
// Buffers that have an address, too, as texels, which lavapipe loads and stores faster.
EDGESPLAT_CONSTANT uint BIND_PICTURE = 11u;        // rgba32f, FrameParams::output_pixels
EDGESPLAT_CONSTANT uint BIND_TILE_COUNTERS = 12u;  // r32ui, FrameParams::tile_counters
EDGESPLAT_CONSTANT uint BIND_TILE_CLOSED = 13u;    // r32ui, FrameParams::tile_closed
EDGESPLAT_CONSTANT uint BIND_TILE_TODO = 14u;      // r32ui, FrameParams::tile_todo
EDGESPLAT_CONSTANT uint BIND_TILE_ENTRIES = 15u;   // rg32ui (pairs at once): place in `order`, sheet; by tile, sheet, number
EDGESPLAT_CONSTANT uint BIND_TILE_MARKS = 16u;     // r32ui: of each MARKED_AT_ONCE entries a word for each cell of their tile (tile_marks.glsl)
EDGESPLAT_CONSTANT uint BIND_TILE_RANGES = 17u;    // rg32ui (tiles): parts of the entries, half open, counted from entries_first
EDGESPLAT_CONSTANT uint BIND_TILE_ORDER = 18u;     // r32ui (tiles, then groups of their pixels): longest list first; with rounds only
EDGESPLAT_CONSTANT uint BIND_TILE_PIXELS = 19u;    // r32ui (tiles, TILE * TILE): which, x | y << 8 in the tile; with refined pixels only
EDGESPLAT_CONSTANT uint BIND_TILE_SHEETS = 20u;    // rgba32f (size.y, size.x): sums of a sheet whose entries go on in the next round
EDGESPLAT_CONSTANT uint BIND_OUTLINES = 21u;       // r32ui (size.y, size.x): where an outline passes each pixel (outline.glsl)
EDGESPLAT_CONSTANT uint BIND_COUNT = 22u;

EDGESPLAT_SHARED_END
#endif
