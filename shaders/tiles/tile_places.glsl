// Selects which pixels of a tile are drawn. Include after the declaration of `what` and of the functions that load the
// tiles' lists of pixels.
#include "shaders/tiles/pixel_in_tile.glsl"
#include "shaders/tiles/pixel_slopes.glsl"

uint tile_count() { return uint(params.frame.tiles.x * params.frame.tiles.y); }

// Refined pixels: first every REFINE_STEP-th pixel, then the listed ones.
const uint FIRST_PIXELS = (TILE / REFINE_STEP) * (TILE / REFINE_STEP);

// Selected without a branch: lavapipe recompiles a branch on a push constant at every bind.
uint pixels_of(uint tile) { return mix(load_todo(tile), FIRST_PIXELS, what >> 31 == 1u); }

// Position of a place in its tile.
ivec2 place_of(uint tile, uint place) {
    if (REFINED == 0u) return pixel_in_tile(place);
    uint listed = load_listed(tile * TILE * TILE + place);
    return mix(ivec2(listed & 0xffu, listed >> 8), int(REFINE_STEP) * pixel_in_tile(place), bvec2(what >> 31 == 1u));
}

// The pixel at a place of a tile; places from `count` on repeat the last one.
ivec2 pixel_of(uint tile, uint place, uint count) {
    ivec2 corner = int(TILE) * ivec2(tile % uint(params.frame.tiles.x), tile / uint(params.frame.tiles.x));
    return corner + place_of(tile, min(place, max(count, 1u) - 1u));
}
