// Sheets of the splats -> splat numbers ordered by sheet, and where each sheet begins, or one draw call per sheet
// group. A stable counting sort.
#pragma once

#include "engine/passes/5_draw_splats.h"

namespace edgesplat::passes {

/// Specialization of 4a_count_sheets.comp and 4a_count_slots.comp, of 4b_scan_sheets.comp, and of
/// 4c_scatter_splats.comp and 4c_scatter_slots.comp.
gpu::Specialization count_constants(const DrawVariant& variant);
gpu::Specialization scan_constants(const DrawVariant& variant);
gpu::Specialization scatter_constants(const DrawVariant& variant);

/// FrameParams: reads `sheets`, uses `counters` (which must be zero), writes `order` and, with tiles, `sheet_starts`,
/// else `groups` and `draws`.
/// `segments`: into which blocks of slots are divided, each of FrameParams::sort_segment, where slots are not sorted
/// side by side.
void sort_sheets(gpu::Commands& commands, const DrawVariant& variant, const shader::FrameParams& params,
                 std::uint32_t segments);

/// Whether slots find their places side by side: only where sheets are summed tile by tile.
bool sorts_side_by_side(const DrawVariant& variant, const gpu::DeviceProfile& profile);

}  // namespace edgesplat::passes
