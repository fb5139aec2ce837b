// What keeps loops short: lavapipe ends every loop of an invocation once all of them together have gone round 65535 times, without
// a word. Profiles with `rounds`, and without `side_by_side`, count on it (engine/gpu/device_profile.h).
#ifndef EDGESPLAT_ITERATIONS_H
#define EDGESPLAT_ITERATIONS_H
#include "shaders/shared/glue.h"
EDGESPLAT_SHARED_BEGIN

EDGESPLAT_CONSTANT uint MOST_ITERATIONS = 50000u;
EDGESPLAT_CONSTANT uint TILE_ROUND = 512u;  // entries of a tile's list that are drawn at once, each good for 128 at most
EDGESPLAT_CONSTANT uint TILE_FIRST_ROUND = 128u;  // likewise, of the first round, after which near views have most pixels closed
EDGESPLAT_CONSTANT uint BLOCK_PAIRS = 4096u;  // pairs of splat and tile in a column of the tiles' histogram, on average
EDGESPLAT_CONSTANT uint PAIR_STEPS = 12000u;  // of them that are gone through at once, each good for two iterations
EDGESPLAT_CONSTANT uint COLUMN_STATE = 4u;    // words behind the histogram: how far each of two passes got in a column

EDGESPLAT_SHARED_END
#endif
