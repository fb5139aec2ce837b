// Sheets of a picture seen from a light -> optical depth from there to every sheet -> what reaches each splat.
#pragma once

#include "engine/gpu/commands.h"
#include "engine/passes/clip_count.h"

namespace edgesplat::passes {

/// FrameParams of the light's picture at `frame`. With the group drawn and not yet composited: writes the optical depth
/// so far behind each of its sheets to `light_layers`.
void sweep_light(gpu::Commands& commands, const glm::ivec2& size, std::uint32_t group);

/// With every group swept: writes half `channel` (0 or 1) of `splat_shadows` for the splats that lie in the picture.
void shadow_splats(gpu::Commands& commands, std::uint64_t splat_count, const ClipCount& clip, std::uint32_t channel);

}  // namespace edgesplat::passes
