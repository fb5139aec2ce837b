// Lists by tile -> picture: passes 5 and 6 in one, each pixel's sums in registers.
#pragma once

#include "engine/passes/5_draw_splats.h"
#include "shaders/drivers/iterations.h"

namespace edgesplat::passes {

/// How tiles are drawn. None of it changes the picture.
struct TileDraw {
    /// With its rounds only entries [round_begin(round), round_begin(round + 1)) of each list are drawn.
    const gpu::DeviceProfile* profile = &gpu::device_profiles().front();
    bool count = false;    ///< FrameParams::drawn counts footprints
    bool prepared = true;  ///< the chunk's splats are in `prepared_splats`
    bool part = false;     ///< some of the sheets: the picture is not finished with them
    bool planned = false;  ///< by the device: the host does not know its chunks, but that they fit
    bool refined = false;  ///< only the pixels of `tile_pixels`, or every REFINE_STEP-th
    bool wide_marks =
        false;  ///< entries are marked for 4 x 2 pixels at once; of refined pixels, which lie apart, always
};

/// Invocations of a workgroup, a pixel each. Lists of pixels are of very different length.
std::uint32_t tile_group(TileDraw how);

constexpr std::uint32_t round_begin(std::uint32_t round) {
    return round == 0 ? 0 : shader::TILE_FIRST_ROUND + (round - 1) * shader::TILE_ROUND;
}

/// What one of these dispatches draws.
struct TileRound {
    std::uint64_t groups = 0;       ///< workgroups: with rounds of `tile_order`, else `tile_groups` of every tile
    std::uint32_t round = 0;        ///< of the lists of entries
    std::uint32_t tile_groups = 1;  ///< of a tile: groups are numbered tile * tile_groups + group of the tile
    bool first_pixels = false;      ///< of refined ones: every REFINE_STEP-th, not those that are listed
};

/// FrameParams: where the rays of the round's pixels meet the surface, for entries in `traced_entries`, into
/// `traced_rays`. Reads the field's coefficients.
void trace_faces(gpu::Commands& commands, const DrawVariant& variant, TileDraw how, std::uint64_t tiles,
                 const TileRound& round);

/// FrameParams: reads `tile_ranges`, `tile_entries` and `prepared_splats` or the splats, puts the chunk's sheets behind
/// what `output_pixels` holds (premultiplied colour and opacity; with PAYLOAD_TAU a plain sum), and counts closed
/// pixels in `tile_closed`. `tile_sheets` holds what a round leaves unfinished.
void draw_tiles(gpu::Commands& commands, const DrawVariant& variant, TileDraw how, const TileRound& round);

/// Specialization of 5_trace_faces.comp, and of 5_draw_tiles.comp.
gpu::Specialization trace_constants(const DrawVariant& variant, TileDraw how);
gpu::Specialization tile_constants(const DrawVariant& variant, TileDraw how);

}  // namespace edgesplat::passes
