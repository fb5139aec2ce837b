// Splat records -> for each splat: whether it is in the picture, its sheet, its layers of the footprint table and their
// rotation; for each sheet group: the pixels that it touches.
#pragma once

#include "engine/gpu/commands.h"
#include "engine/passes/5_draw_splats.h"

namespace edgesplat::passes {

/// FrameParams at `frame`: reads `splats`; writes `sheets` and, with a table, `footprints`; grows each `rect` of
/// `groups`, which must be empty before. In sliced views a splat belongs to every sheet that its support touches.
/// Splats that are clipped completely are culled.
gpu::Pass select_footprints(std::uint64_t slots, const DrawVariant& variant);

}  // namespace edgesplat::passes
