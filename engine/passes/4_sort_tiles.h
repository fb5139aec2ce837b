// Sorted splats -> tile lists: for each tile the splats of a chunk of sheets that touch it, sheet by sheet. A stable
// counting sort.
#pragma once

#include <span>

#include "engine/gpu/buffer.h"
#include "engine/gpu/commands.h"

namespace edgesplat::passes {

/// FrameParams: reads chunk `chunk` of `order`, `tile_rects`, `sheet_starts` and `tile_closed`; uses `tile_counters`
/// (which must be zero); writes `tile_ranges` and `tile_entries`. Saturated tiles get no list. `steps`: number of
/// dispatches of PAIR_STEPS pairs for the fullest column; not used by the parallel sort.
gpu::Pass sort_tiles(const gpu::DeviceProfile& profile, const shader::FrameParams& params, std::uint32_t chunk,
                     std::uint32_t steps);

/// Plans the chunks on the device: reads `sheet_pairs` and `sheet_starts`, writes `chunk_slots` ranges into `chunks`.
/// They are those of edgesplat::plan_chunks(), then empty ones. A chunk with more than `chunk_pairs` pairs, or more
/// splats than are prepared at once, is left empty.
gpu::Pass plan_chunks();

}  // namespace edgesplat::passes
