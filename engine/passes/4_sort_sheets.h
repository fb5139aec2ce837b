// Sheets of the splats -> splat numbers ordered by sheet, and one draw call per sheet group. A stable counting sort.
#pragma once

#include "engine/gpu/commands.h"

namespace edgesplat::passes {

/// FrameParams at `frame`: reads `sheets`, uses `counters` (which must be zero), writes `order`, `groups` and `draws`.
void sort_sheets(gpu::Commands& commands, bool sliced);

}  // namespace edgesplat::passes
