// Splat records -> which of them are in the picture, in which sheet, and the pixels that each sheet group touches.
#pragma once

#include "engine/gpu/commands.h"
#include "engine/passes/clip_count.h"

namespace edgesplat::passes {

/// FrameParams at `frame`: reads `splats`, writes `sheets`, grows the `rect` of `groups` (which must start out empty).
/// With `sliced` a splat belongs to every sheet that its support touches. What `clip` cuts away whole is not drawn.
void select_footprints(gpu::Commands& commands, shader::Address frame, std::uint64_t splat_count, bool sliced,
                       const ClipCount& clip = {});

}  // namespace edgesplat::passes
