// After shaders that declare WIDE_MARKS.
#include "shaders/drivers/iterations.h"

// Cells of a tile that entries are marked for, row by row: pixels, or 4 x 2 of them.
const uint CELL_X = WIDE_MARKS == 1u ? 4u : 1u;
const uint CELL_Y = WIDE_MARKS == 1u ? 2u : 1u;
const uint CELLS = TILE * TILE / (CELL_X * CELL_Y);

// Where a list's marks begin, one word a cell for every 32 entries; `entry` is a multiple of them.
int first_mark(uint entry) { return int((params.frame.entries_first + entry) / MARKED_AT_ONCE * CELLS); }

// Where it is said which of these entries are traced.
uint word_of(uint entry) { return (params.frame.entries_first + entry) / MARKED_AT_ONCE; }

uint cell_of(ivec2 pixel) { return uint(pixel.y) % TILE / CELL_Y * (TILE / CELL_X) + uint(pixel.x) % TILE / CELL_X; }

// Of a list's entries, the first that a round draws.
uint round_begin(uint draw_round) { return draw_round == 0u ? 0u : TILE_FIRST_ROUND + (draw_round - 1u) * TILE_ROUND; }
