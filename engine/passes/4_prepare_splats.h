// Sorted splats -> records of the values that all pixels of a splat share: position, kernel, colour.
#pragma once

#include "engine/gpu/commands.h"
#include "engine/gpu/image.h"
#include "engine/passes/5_draw_splats.h"

namespace edgesplat::passes {

/// FrameParams: reads the `count` entries of chunk `chunk` in `order` and their splats; writes their records into the
/// image at BIND_PREPARED, which must have at least `count` slots.
gpu::Pass prepare_splats(const DrawVariant& variant, std::uint32_t chunk, std::uint32_t count);

/// Texels per record: PREPARED_STRIDE of shaders/splats/prepared_splat.glsl.
std::uint32_t prepared_stride(const DrawVariant& variant);

/// Size of the rgba32f image for `slots` records, texels.
glm::ivec2 prepared_size(const DrawVariant& variant, std::uint32_t slots);

/// Slots for pictures of at most `entries` entries: a power of two up to PREPARED_ENTRIES. Chunks with more entries
/// than slots are not prepared.
std::uint32_t prepared_slots(std::uint64_t entries);

}  // namespace edgesplat::passes
