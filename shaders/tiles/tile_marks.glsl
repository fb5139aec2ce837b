// Marks of a tile's pixels. The including shader declares WIDE_MARKS.

// Cells of a tile with separate marks, row by row: single pixels, or 4 x 2 pixels.
const uint CELL_X = WIDE_MARKS == 1u ? 4u : 1u;
const uint CELL_Y = WIDE_MARKS == 1u ? 2u : 1u;
const uint CELLS = TILE * TILE / (CELL_X * CELL_Y);

// The beginning of a list's marks: one word per cell for every 32 entries; `entry` is a multiple of 32.
int first_mark(uint entry) { return int((params.frame.entries_first + entry) / MARKED_AT_ONCE * CELLS); }

// The index of the word that says which of these entries are traced.
uint word_of(uint entry) { return (params.frame.entries_first + entry) / MARKED_AT_ONCE; }

uint cell_of(ivec2 pixel) { return uint(pixel.y) % TILE / CELL_Y * (TILE / CELL_X) + uint(pixel.x) % TILE / CELL_X; }

