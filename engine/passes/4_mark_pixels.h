// Tile lists -> marks: which pixels of the tile each entry reaches.
#pragma once

#include "engine/passes/5_draw_tiles.h"

namespace edgesplat::passes {

/// FrameParams: reads `tile_ranges`, `tile_entries` and `prepared_splats` or the splats; writes to `tile_marks` which
/// entries of `round` reach each pixel of a tile (each 4 x 2 pixels in refined pictures). `tiles`: with rounds the
/// first tiles of `tile_order`, else all tiles. Saturated tiles get no marks. In refined pictures, words that are not
/// all ones are marked already and stay; `tile_finest` is written, too.
gpu::Pass mark_pixels(const DrawVariant& variant, TileDraw how, std::uint64_t tiles, std::uint32_t round);
}  // namespace edgesplat::passes
