// Which pixels of a tile are drawn. After the declaration of `what` and of what loads the tiles' lists of pixels.
#include "shaders/tiles/pixel_in_tile.glsl"

uint tile_count() { return uint(params.frame.tiles.x * params.frame.tiles.y); }

// Of refined pixels every REFINE_STEP-th comes first, then those that are listed.
const uint FIRST_PIXELS = (TILE / REFINE_STEP) * (TILE / REFINE_STEP);

// Selected, not branched for: lavapipe compiles what a push constant decides anew at every bind.
uint pixels_of(uint tile) { return mix(load_todo(tile), FIRST_PIXELS, what >> 31 == 1u); }

ivec2 place_of(uint tile, uint place) {
    if (REFINED == 0u) return pixel_in_tile(place);
    uint listed = load_listed(tile * TILE * TILE + place);
    return mix(ivec2(listed & 0xffu, listed >> 8), int(REFINE_STEP) * pixel_in_tile(place), bvec2(what >> 31 == 1u));
}
