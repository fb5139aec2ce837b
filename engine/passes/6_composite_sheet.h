// A sheet group -> accumulated picture: turns optical depth into opacity and composites sheets front to back.
#pragma once

#include "engine/gpu/commands.h"

namespace edgesplat::passes {

/// Clears the accumulated picture; once per frame, before the first group.
void clear_accumulated(gpu::Commands& commands, const gpu::GpuImage& accumulated);

/// Composites the group's sheets behind `accumulated` (RGBA32F), in the pixels that the group touches.
/// `payload`: shader::PAYLOAD_*; PAYLOAD_TAU is summed instead.
void composite_sheet(gpu::Commands& commands, const gpu::GpuImage& accumulated, std::uint32_t payload,
                     std::uint32_t group);

}  // namespace edgesplat::passes
