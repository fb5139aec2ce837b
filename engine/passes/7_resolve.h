// Accumulated picture -> pixels for the host.
#pragma once

#include "engine/passes/5_draw_splats.h"

namespace edgesplat::passes {

/// FrameParams: writes `output_pixels`, (height, width) vec4, linear light. Tiled pictures are resolved in place.
/// `gradient`: the background has two colours.
gpu::Pass resolve(const DrawVariant& variant, const glm::ivec2& size, bool gradient);

}  // namespace edgesplat::passes
