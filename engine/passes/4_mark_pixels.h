// Lists by tile -> which pixels of its tile each entry is for.
#pragma once

#include "engine/passes/5_draw_tiles.h"

namespace edgesplat::passes {

/// FrameParams: reads `tile_ranges`, `tile_entries` and `prepared_splats` or the splats; writes `tile_marks`, for each
/// pixel of a tile, of refined ones 4 x 2 of them, which entries of `round` reach it. `tiles`: with rounds the first so
/// many of `tile_order`, else all. Tiles that are closed get no marks. Of refined pixels what is marked already stays,
/// which is where words are not all ones, and `tile_finest` is found.
void mark_pixels(gpu::Commands& commands, const DrawVariant& variant, TileDraw how, std::uint64_t tiles,
                 std::uint32_t round);

/// Specialization of 4h_mark_pixels.comp.
gpu::Specialization mark_pixels_constants(const DrawVariant& variant, TileDraw how);

}  // namespace edgesplat::passes
