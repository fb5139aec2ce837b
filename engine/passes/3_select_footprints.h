// Splat records -> which of them are in the picture, in which sheet, by which layers of the table of footprints, turned
// how, and the pixels that each sheet group touches.
#pragma once

#include "engine/gpu/commands.h"
#include "engine/passes/5_draw_splats.h"

namespace edgesplat::passes {

/// Specialization of 3_select_footprints.comp.
gpu::Specialization select_constants(const DrawVariant& variant);

/// FrameParams at `frame`: reads `splats`, writes `sheets` and, with a table, `footprints`, grows the `rect` of
/// `groups` (which must start out empty). Sliced, a splat belongs to every sheet that its support touches. What clip
/// planes cut away whole is not drawn.
void select_footprints(gpu::Commands& commands, std::uint64_t slots, const DrawVariant& variant);

}  // namespace edgesplat::passes
