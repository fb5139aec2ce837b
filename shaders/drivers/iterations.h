// Limits that keep loops short. lavapipe silently ends all loops of an invocation after 65535 iterations in total.
// Profiles with `rounds`, and profiles without `side_by_side`, rely on these limits (engine/gpu/device_profile.h).
#ifndef EDGESPLAT_ITERATIONS_H
#define EDGESPLAT_ITERATIONS_H
#include "shaders/shared/glue.h"
EDGESPLAT_SHARED_BEGIN

EDGESPLAT_CONSTANT uint MOST_ITERATIONS = 50000u;
EDGESPLAT_CONSTANT uint TILE_ROUND = 512u;  // entries of a tile list that are drawn in one round; at most 128 iterations per entry
EDGESPLAT_CONSTANT uint TILE_FIRST_ROUND = 128u;  // likewise, in the first round; after it most pixels of near views are saturated
EDGESPLAT_CONSTANT uint BLOCK_PAIRS = 4096u;  // average number of pairs of splat and tile in a column of the tile histogram
EDGESPLAT_CONSTANT uint PAIR_STEPS = 12000u;  // pairs that are processed at once; two iterations per pair
EDGESPLAT_CONSTANT uint COLUMN_STATE = 4u;    // words behind the histogram: progress of each of the two passes in a column

EDGESPLAT_SHARED_END
#endif
