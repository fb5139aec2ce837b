#include "engine/plan/sizes.h"

#include <algorithm>

namespace edgesplat {
namespace {

// Above this number of tiles fewer pairs are sorted at once, since the histogram has a row per tile.
constexpr std::uint64_t kManyTiles = std::uint64_t{1} << 17U;

}  // namespace

std::uint64_t tile_counter_bytes(const glm::ivec2& tiles, std::uint32_t blocks) {
    const std::uint64_t count = static_cast<std::uint64_t>(tiles.x) * static_cast<std::uint64_t>(tiles.y);
    return (count + shader::COLUMN_STATE) * blocks * sizeof(std::uint32_t);
}

std::uint32_t tile_blocks(const glm::ivec2& tiles, const gpu::DeviceProfile& profile) {
    const std::uint64_t count = static_cast<std::uint64_t>(tiles.x) * static_cast<std::uint64_t>(tiles.y);
    const std::uint64_t most = count > kManyTiles ? profile.tile_blocks / 8 : profile.tile_blocks;
    return static_cast<std::uint32_t>(std::clamp<std::uint64_t>(kMostTileCounters / count, 1, most));
}

std::uint64_t tile_count(const FramePlan& plan) {
    return static_cast<std::uint64_t>(plan.params.tiles.x) * static_cast<std::uint64_t>(plan.params.tiles.y);
}

std::uint64_t picture_bytes(const FramePlan& plan) {
    return static_cast<std::uint64_t>(plan.params.size.x) * static_cast<std::uint64_t>(plan.params.size.y) *
           sizeof(glm::vec4);
}

std::uint64_t chunk_pairs(const glm::ivec2& tiles, const gpu::DeviceProfile& profile) {
    const auto count = static_cast<std::uint64_t>(tiles.x) * static_cast<std::uint64_t>(tiles.y);
    const std::uint64_t most = count > kManyTiles ? profile.chunk_pairs / 8 : profile.chunk_pairs;
    return std::min(most, std::max(profile.tile_pairs * count, std::uint64_t{1} << 12U));
}

std::uint64_t padded_pairs(std::uint64_t pairs, const glm::ivec2& tiles) {
    constexpr std::uint64_t kPart = shader::MARKED_AT_ONCE;
    const std::uint64_t lists = static_cast<std::uint64_t>(tiles.x) * static_cast<std::uint64_t>(tiles.y);
    return (pairs / kPart + 1 + std::min(lists, pairs)) * kPart;
}

std::uint64_t tile_order_items(const FramePlan& plan) {
    const std::uint64_t items =
        tile_count(plan) * tile_groups({.profile = &gpu::device_profiles().front(), .refined = plan.refined}, 1);
    return tile_count(plan) + items;
}

std::uint64_t tile_entry_pairs(const FramePlan& plan, const gpu::DeviceProfile& profile) {
    return padded_pairs(chunk_pairs(plan.params.tiles, profile), plan.params.tiles) * (plan.refined ? 2 : 1);
}

std::uint64_t tile_mark_words(const FramePlan& plan, std::uint64_t pairs) {
    // A picture planned as refined may be drawn without refinement; then its marks need more words per entry.
    const std::uint64_t cells = plan.wide_marks ? shader::TILE * shader::TILE / 8 : shader::TILE * shader::TILE;
    return padded_pairs(pairs, plan.params.tiles) *
           std::max(cells / shader::MARKED_AT_ONCE, std::uint64_t{plan.refined ? 2U : 1U});
}

std::uint64_t traced_words(const FramePlan& plan, std::uint64_t entries) {
    return plan.variant.traced ? entries / shader::MARKED_AT_ONCE : 0;
}

std::uint32_t tile_groups(passes::TileDraw how, std::uint32_t step) {
    if (!how.refined) return shader::TILE * shader::TILE / passes::tile_group(how);
    const std::uint32_t across = shader::TILE / step, coarser = across / 2;
    const std::uint32_t most = step == shader::REFINE_STEP ? across * across : across * across - coarser * coarser;
    return (most + passes::tile_group(how) - 1) / passes::tile_group(how);
}

}  // namespace edgesplat
