// How large the lists of a tiled picture are.
#pragma once

#include "engine/passes/5_draw_tiles.h"
#include "engine/plan/plan.h"

namespace edgesplat {

/// Counters of the tiles' histogram that can be scanned: 256 invocations go through all of them, twice.
inline constexpr std::uint64_t kMostTileCounters = std::uint64_t{128} * shader::MOST_ITERATIONS;

/// The histogram, and how far each of its columns is gone through.
std::uint64_t tile_counter_bytes(const glm::ivec2& tiles, std::uint32_t blocks);

/// Columns of that histogram as a device takes them, as far as can be scanned.
std::uint32_t tile_blocks(const glm::ivec2& tiles, const gpu::DeviceProfile& profile);

std::uint64_t tile_count(const FramePlan& plan);

/// Of colour and opacity of all pixels.
std::uint64_t picture_bytes(const FramePlan& plan);

/// Pairs of a splat and a tile that a chunk of sheets may have.
std::uint64_t chunk_pairs(const glm::ivec2& tiles, const gpu::DeviceProfile& profile);

/// Room that lists of so many pairs take, each from a multiple of MARKED_AT_ONCE on.
std::uint64_t padded_pairs(std::uint64_t pairs, const glm::ivec2& tiles);

/// What FrameParams::tile_order holds at most.
std::uint64_t tile_order_items(const FramePlan& plan);
/// Pairs that FrameParams::tile_entries has room for. Of a refined picture, the lists of several chunks are kept.
std::uint64_t tile_entry_pairs(const FramePlan& plan, const gpu::DeviceProfile& profile);

/// Words that mark for which pixels lists of so many pairs are.
std::uint64_t tile_mark_words(const FramePlan& plan, std::uint64_t pairs);

/// Words that say which of so many entries are traced; none where nothing is.
std::uint64_t traced_words(const FramePlan& plan, std::uint64_t entries);

/// Groups of invocations for the most pixels that a tile draws at once, after that step of a refined picture.
std::uint32_t tile_groups(passes::TileDraw how, std::uint32_t step);

}  // namespace edgesplat
