// Sorted splats -> records of what their pixels share: place, kernel, colour.
#pragma once

#include "engine/gpu/commands.h"
#include "engine/gpu/image.h"
#include "engine/passes/5_draw_splats.h"

namespace edgesplat::passes {

/// FrameParams: reads part `chunk` of `order`, `count` entries, and their splats; writes their records into
/// the image at BIND_PREPARED, which has at least as many slots.
void prepare_splats(gpu::Commands& commands, const DrawVariant& variant, std::uint32_t chunk, std::uint32_t count);

/// Texels of a record: PREPARED_STRIDE of shaders/splats/prepared_splat.glsl.
std::uint32_t prepared_stride(const DrawVariant& variant);

/// Texels of the rgba32f image that holds so many.
glm::ivec2 prepared_size(const DrawVariant& variant, std::uint32_t slots);

/// Slots for pictures of at most so many entries, a power of two up to PREPARED_ENTRIES. Chunks of more are not
/// prepared.
std::uint32_t prepared_slots(std::uint64_t entries);

}  // namespace edgesplat::passes
