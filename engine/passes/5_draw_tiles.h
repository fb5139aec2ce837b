// Tile lists -> picture: passes 5 and 6 in one, with each pixel's sums in registers.
#pragma once

#include "engine/passes/5_draw_splats.h"
#include "shaders/drivers/iterations.h"

namespace edgesplat::passes {

/// How tiles are drawn. Does not change the picture.
struct TileDraw {
    /// If it has rounds, only entries [round_begin(round), round_begin(round + 1)) of each list are drawn.
    const gpu::DeviceProfile* profile = &gpu::device_profiles().front();
    bool count = false;       ///< FrameParams::drawn counts footprints
    bool prepared = true;     ///< the chunk's splats are in `prepared_splats`
    bool part = false;        ///< only some sheets are drawn: the resolve pass is skipped
    bool planned = false;     ///< the device plans the chunks; the host knows only that each can be prepared
    bool refined = false;     ///< draws only the pixels in `tile_pixels`, or those at multiples of REFINE_STEP
    bool wide_marks = false;  ///< a mark covers 4 x 2 pixels; always so with `refined`, whose pixels lie apart
};

/// Invocations per workgroup, one per pixel; fewer for lists of pixels, since their lengths differ widely.
std::uint32_t tile_group(TileDraw how);

constexpr std::uint32_t round_begin(std::uint32_t round) {
    return round == 0 ? 0 : shader::TILE_FIRST_ROUND + (round - 1) * shader::TILE_ROUND;
}

/// The work of one dispatch.
struct TileRound {
    std::uint64_t groups = 0;  ///< workgroups: with rounds the first of `tile_order`, else all tiles' `tile_groups`
    std::uint32_t round = 0;   ///< round of the lists of entries
    std::uint32_t tile_groups = 1;  ///< groups per tile; group number = tile * tile_groups + group of the tile
    bool first_pixels = false;      ///< refined: draws pixels at multiples of REFINE_STEP, not the listed ones
};

/// FrameParams: writes to `traced_rays` where the rays of the round's pixels meet the surface, for entries in
/// `traced_entries`. Reads the field's coefficients. Only if rays trace faces.
gpu::Pass trace_faces(const DrawVariant& variant, TileDraw how, std::uint64_t tiles, const TileRound& round);

/// FrameParams: reads `tile_ranges`, `tile_entries` and `prepared_splats` or the splats; composites the chunk's sheets
/// behind `output_pixels` (premultiplied colour and opacity; with PAYLOAD_TAU a plain sum); counts saturated pixels in
/// `tile_closed`. `tile_sheets` has the sums of a sheet that a round leaves unfinished. In a mixture, kernels end at
/// `seen_ways`, and surfaces that the sheets pass are composited.
/// With surface splats it counts votes in `tile_sheets` and marks decided pixels as opaque.
gpu::Pass draw_tiles(const DrawVariant& variant, TileDraw how, const TileRound& round);

/// FrameParams: clears the pixels' votes, or stores that matter begins where their rays enter the volume or what clip
/// planes keep. Reads the volume and the field's coefficients. Only with DrawVariant::begins.
gpu::Pass begin_surfaces(const DrawVariant& variant, const glm::ivec2& size);

/// Writes the colour, or other payload, of the surfaces that the pixels' votes decide; or, as
/// round 1, only marks the pixels as opaque that are decided up to FrameParams::sheets_drawn. `round`: all pixels of a
/// step. In a mixture, it also writes `seen_surfaces` and `seen_ways`. Only with surface splats.
gpu::Pass shade_surfaces(const DrawVariant& variant, TileDraw how, const TileRound& round);

}  // namespace edgesplat::passes
