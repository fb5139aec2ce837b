// Sheets of a light's picture -> optical depth from the light to every sheet -> light that reaches each splat.
#pragma once

#include "engine/gpu/commands.h"
#include "engine/passes/clip_count.h"

namespace edgesplat::passes {

/// Writes the accumulated optical depth behind each sheet of the group to `light_layers`. Runs after the group is drawn
/// and before it is composited. `frame` has the FrameParams of the light's picture.
void sweep_light(gpu::Commands& commands, const glm::ivec2& size, std::uint32_t group);

/// After all groups are swept: writes half `channel` (0 or 1) of `splat_shadows` for the splats inside the picture.
void shadow_splats(gpu::Commands& commands, std::uint64_t splat_count, const ClipCount& clip, std::uint32_t channel);

}  // namespace edgesplat::passes
