// Kernels' picture and the surfaces behind it -> one picture.
#pragma once

#include "engine/gpu/commands.h"

namespace edgesplat::passes {

/// FrameParams: composites the surfaces in `seen_surfaces` that no sheet passed behind `output_pixels`. Only in a
/// mixture.
gpu::Pass join_surfaces(const DrawVariant& variant, const glm::ivec2& size);

}  // namespace edgesplat::passes
