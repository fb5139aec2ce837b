// A tiled picture is drawn in chunks of sheets: which ones, and what is drawn first.
#pragma once

#include <span>
#include <vector>

#include "engine/plan/resources.h"
#include "engine/plan/sizes.h"

namespace edgesplat {

/// Consecutive sheets that are drawn at once.
struct Chunks {
    std::vector<glm::uvec2> parts;  ///< of the sorted order, half open; empty ones are left out
    std::uint64_t most_pairs = 0;   ///< of any chunk
    glm::uvec2 sheets{0};           ///< the sheets that are drawn, half open
    std::uint64_t pairs = 0;        ///< of all chunks
    std::uint64_t entries = 0;      ///< of the order, in all of them
};

/// `pairs` per sheet that is drawn; `starts`: where each sheet begins in the order, and where the last one ends. A
/// sheet is never divided: one with more than `limit` pairs, or `entries` of the order, is a chunk of its own.
Chunks plan_chunks(std::span<const std::uint32_t> pairs, std::span<const std::uint32_t> starts, std::uint64_t limit,
                   std::uint64_t entries = ~std::uint64_t{0});

/// At least as many pairs as any column of a chunk has: those of all sheets that reach into it. `part` of the order,
/// divided into so many columns of equal length; `pairs` and `starts` of all sheets.
std::uint64_t most_column_pairs(const glm::uvec2& part, std::uint32_t columns, std::span<const std::uint32_t> pairs,
                                std::span<const std::uint32_t> starts);

/// Of each sheet of a picture that was sorted, pairs of a splat and a tile; where each begins in the order, and the
/// end.
std::span<const std::uint32_t> sheet_pairs(const FramePlan& plan, const TargetResources& targets);
std::span<const std::uint32_t> sheet_starts(const FramePlan& plan, const TargetResources& targets);

/// The chunks of such a picture's sheets, half open.
Chunks chunks_of(const FramePlan& plan, const TargetResources& targets, const glm::uvec2& sheets,
                 const gpu::DeviceProfile& profile);

/// Whether the chunks are those that the device plans (4d_plan_chunks.comp), with nothing left out.
bool fit(const Chunks& chunks, const shader::FrameParams& params);

/// Whether drawing some pixels first (FramePlan::refined) saves time: splats are some pixels wide.
bool worth_refining(const Chunks& chunks);

/// The first of a picture's steps; each is half of the one before, the last is 1.
std::uint32_t first_step(const FramePlan& plan);

/// How many pixels of each tile are drawn first.
void fill_todo(const FramePlan& plan, const TargetResources& targets);

}  // namespace edgesplat
