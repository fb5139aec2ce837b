// Sheets of the splats -> splat numbers ordered by sheet, and where each sheet begins, or one draw call per sheet
// group. A stable counting sort.
#pragma once

#include "engine/passes/5_draw_splats.h"

namespace edgesplat::passes {

/// Specialization of 4a_count_sheets.comp, of 4b_scan_sheets.comp and of 4c_scatter_splats.comp.
gpu::Specialization count_constants(const DrawVariant& variant);
gpu::Specialization scan_constants(const DrawVariant& variant);
gpu::Specialization scatter_constants(const DrawVariant& variant);

/// FrameParams: reads `sheets`, uses `counters` (which must be zero), writes `order` and, with tiles, `sheet_starts`,
/// else `groups` and `draws`.
/// `segments`: into which blocks of slots are divided, each of FrameParams::sort_segment.
void sort_sheets(gpu::Commands& commands, const DrawVariant& variant, std::uint32_t segments);

}  // namespace edgesplat::passes
