// Sheets of the splats -> splat numbers ordered by sheet, and where each sheet begins, or one draw call per sheet
// group. A stable counting sort.
#pragma once

#include <vector>

#include "engine/passes/5_draw_splats.h"

namespace edgesplat::passes {

struct SortStep {
    const char* shader;
    gpu::Specialization constants;
};

/// What it runs, in this order. Slots find their places side by side only where sheets are summed tile by tile.
std::vector<SortStep> sort_sheets_steps(const DrawVariant& variant, const gpu::DeviceProfile& profile);

/// FrameParams: reads `sheets`, uses `counters` (which must be zero), writes `order` and, with tiles, `sheet_starts`,
/// else `groups` and `draws`.
/// `segments`: into which blocks of slots are divided, each of FrameParams::sort_segment, where slots are not sorted
/// side by side.
void sort_sheets(gpu::Commands& commands, const DrawVariant& variant, const shader::FrameParams& params,
                 std::uint32_t segments);

}  // namespace edgesplat::passes
