// Sizes of the lists of a tiled picture.
#pragma once

#include "engine/passes/5_draw_tiles.h"
#include "engine/plan/plan.h"

namespace edgesplat {

/// Maximum number of counters of the tiles' histogram: 256 invocations iterate over all of them, twice.
inline constexpr std::uint64_t kMostTileCounters = std::uint64_t{128} * shader::MOST_ITERATIONS;

/// Bytes of the histogram, with the progress of each of its columns.
std::uint64_t tile_counter_bytes(const glm::ivec2& tiles, std::uint32_t blocks);

/// Columns of that histogram: the profile's number, limited by kMostTileCounters.
std::uint32_t tile_blocks(const glm::ivec2& tiles, const gpu::DeviceProfile& profile);

std::uint64_t tile_count(const FramePlan& plan);

/// Bytes of colour and opacity of all pixels.
std::uint64_t picture_bytes(const FramePlan& plan);

/// Maximum number of (splat, tile) pairs of a chunk of sheets.
std::uint64_t chunk_pairs(const glm::ivec2& tiles, const gpu::DeviceProfile& profile);

/// Upper bound of entries that the lists of `pairs` pairs occupy; each begins at a multiple of MARKED_AT_ONCE.
std::uint64_t padded_pairs(std::uint64_t pairs, const glm::ivec2& tiles);

/// Maximum number of elements of FrameParams::tile_order.
std::uint64_t tile_order_items(const FramePlan& plan);
/// Number of pairs FrameParams::tile_entries has room for: twice a chunk's in refined pictures, which keep the lists of
/// several chunks.
std::uint64_t tile_entry_pairs(const FramePlan& plan, const gpu::DeviceProfile& profile);

/// Words of the marks that tell which pixels each of so many pairs reaches.
std::uint64_t tile_mark_words(const FramePlan& plan, std::uint64_t pairs);

/// Words of the bit mask of traced entries; 0 without traced faces.
std::uint64_t traced_words(const FramePlan& plan, std::uint64_t entries);

/// Workgroups for the most pixels that a tile can draw in that step of a refined picture.
std::uint32_t tile_groups(passes::TileDraw how, std::uint32_t step);

}  // namespace edgesplat
