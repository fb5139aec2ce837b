// Some pixels -> those between them, where the picture is smooth, or the list of those that must be drawn.
#pragma once

#include "engine/gpu/commands.h"

namespace edgesplat::passes {

/// FrameParams: reads and writes `output_pixels`, in which every `step`-th pixel of every `step`-th row is there,
/// STEP >= 2 a power of two that divides TILE; afterwards those of half the step are, or are listed in `tile_pixels`
/// and counted in `tile_todo`. `tile_closed` counts from 0 again.
void refine_pixels(gpu::Commands& commands, std::uint64_t tiles, std::uint32_t step);

/// Specialization of 5_refine_pixels.comp.
gpu::Specialization refine_constants(std::uint32_t step);

}  // namespace edgesplat::passes
