// Lists by tile -> picture: passes 5 and 6 in one, each pixel's sums in registers.
#pragma once

#include "engine/passes/5_draw_splats.h"

namespace edgesplat::passes {

/// What of drawing is no matter of the picture.
struct TileDraw {
    bool rounds = true;    ///< only entries [round * TILE_ROUND, (round + 1) * TILE_ROUND) of each list
    bool count = false;    ///< FrameParams::drawn counts footprints
    bool prepared = true;  ///< the chunk's splats are in `prepared_splats`
    bool part = false;     ///< some of the sheets: the picture is not finished with them
};

/// FrameParams: reads `tile_ranges`, `tile_entries` and `prepared_splats` or the splats, puts the chunk's sheets behind
/// what `output_pixels` holds (premultiplied colour and opacity; with PAYLOAD_TAU a plain sum), and counts closed
/// pixels in `tile_closed`. `tile_sheets` holds what a round leaves unfinished. `tiles`: how many; with rounds the
/// first so many of `tile_order`, else all.
void draw_tiles(gpu::Commands& commands, const DrawVariant& variant, std::uint64_t tiles, TileDraw how,
                std::uint32_t round);

/// Specialization of 5_draw_tiles.comp.
gpu::Specialization tile_constants(const DrawVariant& variant, TileDraw how);

}  // namespace edgesplat::passes
