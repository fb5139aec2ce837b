// A sheet group -> the accumulated picture: extinction to opacity, sheet by sheet, front to back.
#pragma once

#include "engine/gpu/commands.h"

namespace edgesplat::passes {

/// Empties the accumulated picture; once a frame, before the first group.
void clear_accumulated(gpu::Commands& commands, const gpu::GpuImage& accumulated);

/// Puts the group's sheets behind what `accumulated` (RGBA32F) holds, within the pixels that the group touches.
/// `payload` is shader::PAYLOAD_*; optical depth is summed instead.
void composite_sheet(gpu::Commands& commands, const gpu::GpuImage& accumulated, std::uint32_t payload,
                     std::uint32_t group);

}  // namespace edgesplat::passes
