// Sheets of the splats -> splat numbers ordered by sheet, with the start of each sheet (tiles) or one draw call per
// sheet group (layers). A stable counting sort.
#pragma once

#include <vector>

#include "engine/passes/5_draw_splats.h"

namespace edgesplat::passes {

/// FrameParams: reads `sheets`, uses `counters` (which must be zero), writes `order` and, with tiles, `sheet_starts`,
/// else `groups` and `draws`. The parallel sort (DeviceProfile::side_by_side) is used only for tiled pictures.
/// `segments`: number of segments of a block of slots, each of FrameParams::sort_segment slots; not used by the
/// parallel sort.
gpu::Pass sort_sheets(const gpu::DeviceProfile& profile, const DrawVariant& variant, const shader::FrameParams& params,
                      std::uint32_t segments);

}  // namespace edgesplat::passes
