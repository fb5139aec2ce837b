// Sheets of the splats -> splat numbers ordered by sheet, and where each sheet begins, or one draw call per sheet
// group. A stable counting sort.
#pragma once

#include "engine/gpu/commands.h"

namespace edgesplat::passes {

/// Specialization of 4b_scan_sheets.comp.
gpu::Specialization scan_constants(bool tiles);

/// FrameParams: reads `sheets`, uses `counters` (which must be zero), writes `order` and, with `tiles`, `sheet_starts`,
/// else `groups` and `draws`.
/// `segments`: into which blocks of splats are divided, each of FrameParams::sort_segment.
void sort_sheets(gpu::Commands& commands, bool sliced, bool tiles, std::uint32_t segments);

}  // namespace edgesplat::passes
