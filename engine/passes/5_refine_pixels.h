// Drawn pixels -> pixels between them: interpolates them where the picture is smooth, lists them for drawing elsewhere.
#pragma once

#include "engine/passes/5_draw_splats.h"

namespace edgesplat::passes {

/// FrameParams: reads and writes `output_pixels`. Before, the pixels at multiples of `step` are known; `step` >= 2 is a
/// power of two that divides TILE. Afterwards each pixel at multiples of `step` / 2 is known, or is listed in
/// `tile_pixels` and counted in `tile_todo`. Resets `tile_closed` to 0.
/// In a mixture, only pixels whose rays end at one smooth surface, or at none, are interpolated; those of surface
/// splats with the surface that kernels end at.
gpu::Pass refine_pixels(const DrawVariant& variant, std::uint64_t tiles, std::uint32_t step);

}  // namespace edgesplat::passes
