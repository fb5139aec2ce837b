// Rounds (engine/frame/tiles_cpu/rounds.h): each draws some entries of every list, and the host lists the tiles that a
// round reaches. On other devices there is one round of whole lists, and tiles are numbered row by row. Include after
// the declarations of load_order() and tile_count().
#include "shaders/drivers/iterations.h"
layout(constant_id = SPEC_ROUNDS) const uint ROUNDS = 1u;

// The tile of a workgroup.
uint tile_in_round(uint number) {
    if (ROUNDS == 1u) return load_order(number);
    return number;
}

// The workgroup's number among the groups of pixels of all tiles.
uint pixels_in_round(uint number) {
    if (ROUNDS == 1u) return load_order(tile_count() + number);
    return number;
}

uint round_begin(uint draw_round) { return draw_round == 0u ? 0u : TILE_FIRST_ROUND + (draw_round - 1u) * TILE_ROUND; }

// The entries of a list that a round draws.
uvec2 entries_in_round(uvec2 range, uint draw_round) {
    if (ROUNDS == 1u) return uvec2(range.x + round_begin(draw_round), min(range.x + round_begin(draw_round + 1u), range.y));
    return range;
}
