// Sheets of the splats -> splat numbers ordered by sheet, with the start of each sheet (tiles) or one draw call per
// sheet group (layers). A stable counting sort.
#pragma once

#include <vector>

#include "engine/passes/5_draw_splats.h"

namespace edgesplat::passes {

struct SortStep {
    const char* shader;
    gpu::Specialization constants;
};

/// The shaders of the sort, in order. The parallel sort (DeviceProfile::side_by_side) is used only for tiled pictures.
std::vector<SortStep> sort_sheets_steps(const DrawVariant& variant, const gpu::DeviceProfile& profile);

/// FrameParams: reads `sheets`, uses `counters` (which must be zero), writes `order` and, with tiles, `sheet_starts`,
/// else `groups` and `draws`.
/// `segments`: number of segments of a block of slots, each of FrameParams::sort_segment slots; not used by the
/// parallel sort.
void sort_sheets(gpu::Commands& commands, const DrawVariant& variant, const shader::FrameParams& params,
                 std::uint32_t segments);

}  // namespace edgesplat::passes
