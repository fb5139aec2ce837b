// Accumulated picture -> pixels for the host.
#pragma once

#include "engine/gpu/commands.h"

namespace edgesplat::passes {

/// FrameParams at `frame`: writes `output_pixels`, (height, width) vec4, linear light. `gradient`: the background is of
/// two colours.
void resolve(gpu::Commands& commands, const glm::ivec2& size, std::uint32_t payload, bool gradient);

}  // namespace edgesplat::passes
