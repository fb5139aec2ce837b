// Chooses the chunks of sheets of a tiled picture.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "engine/plan/resources.h"
#include "engine/plan/sizes.h"

namespace edgesplat {

/// Chunks of a picture: each is a range of consecutive sheets that are drawn at once.
struct Chunks {
    std::vector<glm::uvec2> parts;  ///< ranges of the sorted order, half open; without empty ones
    std::uint64_t most_pairs = 0;   ///< pairs of the largest chunk
    glm::uvec2 sheets{0};           ///< the sheets drawn, half open
    std::uint64_t pairs = 0;        ///< (splat, tile) pairs of all chunks
    std::uint64_t entries = 0;      ///< entries of the order in all chunks
};

/// `pairs`: of each sheet drawn. `starts`: the index in the order where each sheet begins, then the end of the last. A
/// chunk has at most `limit` pairs and `entries` entries of the order. A sheet is never divided: a larger sheet becomes
/// a chunk of its own.
Chunks plan_chunks(std::span<const std::uint32_t> pairs, std::span<const std::uint32_t> starts, std::uint64_t limit,
                   std::uint64_t entries = ~std::uint64_t{0});

/// Upper bound of the pairs per column of a chunk: the pairs of all sheets that overlap the column. `part`: the chunk's
/// range of the order, divided into `columns` columns of equal length. `pairs` and `starts`: of all sheets.
std::uint64_t most_column_pairs(const glm::uvec2& part, std::uint32_t columns, std::span<const std::uint32_t> pairs,
                                std::span<const std::uint32_t> starts);

/// Of a sorted picture: the number of (splat, tile) pairs of each sheet; the index in the order where each sheet
/// begins, then the end of the last.
std::span<const std::uint32_t> sheet_pairs(const FramePlan& plan, const TargetResources& targets);
std::span<const std::uint32_t> sheet_starts(const FramePlan& plan, const TargetResources& targets);

/// The chunks of a sorted picture's `sheets` (half open).
Chunks chunks_of(const FramePlan& plan, const TargetResources& targets, const glm::uvec2& sheets,
                 const gpu::DeviceProfile& profile);

/// Whether the device can plan these chunks (4d_plan_chunks.comp) completely: at most `slots`, none too large.
bool fit(const Chunks& chunks, const shader::FrameParams& params, std::size_t slots);

}  // namespace edgesplat
