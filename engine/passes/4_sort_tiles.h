// Sorted splats -> lists by tile: the splats of a chunk of sheets that touch each tile, sheet by sheet. A stable
// counting sort.
#pragma once

#include <span>

#include "engine/gpu/buffer.h"
#include "engine/gpu/commands.h"

namespace edgesplat::passes {

/// FrameParams: reads part `chunk` of `order`, `tile_rects`, `sheet_starts` and `tile_closed`; uses `tile_counters`,
/// which are `counters`; writes `tile_ranges` and `tile_entries`. Tiles that are closed get nothing. `steps`:
/// dispatches of PAIR_STEPS pairs that the fullest of the columns takes, where pairs are not sorted side by side.
void sort_tiles(gpu::Commands& commands, const gpu::Buffer& counters, const shader::FrameParams& params,
                std::uint32_t chunk, std::uint32_t steps);

/// Reads `sheet_pairs` and `sheet_starts`, writes `chunk_slots` parts into `chunks`: those of plan_chunks() in the
/// first ones; one of more than `chunk_pairs`, or of more splats than are prepared at once, is left empty.
void plan_chunks(gpu::Commands& commands);

/// The shaders of both; of a picture that is refined its chunks are planned by the host.
std::span<const char* const> sort_tiles_shaders(const gpu::DeviceProfile& profile, bool refined);

}  // namespace edgesplat::passes
