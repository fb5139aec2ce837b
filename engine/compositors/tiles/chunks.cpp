#include "engine/compositors/tiles/chunks.h"

#include <algorithm>

namespace edgesplat {

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

Chunks plan_chunks(std::span<const std::uint32_t> pairs, std::span<const std::uint32_t> starts, std::uint64_t limit,
                   std::uint64_t entries) {
    Chunks chunks;
    std::uint64_t sum = 0;
    std::uint32_t begin = starts.front();
    const auto close = [&](std::uint32_t end) {
        if (end > begin) chunks.parts.emplace_back(begin, end);
        chunks.most_pairs = std::max(chunks.most_pairs, sum);
        begin = end;
        chunks.pairs += sum;
        sum = 0;
    };
    for (std::size_t sheet = 0; sheet < pairs.size(); ++sheet) {
        if (sum > 0 && (sum + pairs[sheet] > limit || starts[sheet + 1] - begin > entries)) close(starts[sheet]);
        sum += pairs[sheet];
    }
    close(starts.back());
    return chunks;
}

std::uint64_t most_column_pairs(const glm::uvec2& part, std::uint32_t columns, std::span<const std::uint32_t> pairs,
                                std::span<const std::uint32_t> starts) {
    const std::uint32_t length = std::max((part.y - part.x + columns - 1) / columns, 1U);
    const auto sheet_of = [&](std::uint32_t entry) {
        return static_cast<std::size_t>(std::ranges::upper_bound(starts, entry) - starts.begin()) - 1;
    };
    std::uint64_t most = 0;
    for (std::uint32_t first = part.x; first < part.y; first += length) {
        std::uint64_t sum = 0;
        const std::size_t last = sheet_of(std::min(first + length, part.y) - 1);
        for (std::size_t sheet = sheet_of(first); sheet <= last; ++sheet)
            sum += pairs[sheet];
        most = std::max(most, sum);
    }
    return most;
}

std::uint64_t tile_count(const FramePlan& plan) {
    return static_cast<std::uint64_t>(plan.params.tiles.x) * static_cast<std::uint64_t>(plan.params.tiles.y);
}

std::uint64_t picture_bytes(const FramePlan& plan) {
    return static_cast<std::uint64_t>(plan.params.size.x) * static_cast<std::uint64_t>(plan.params.size.y) *
           sizeof(glm::vec4);
}

std::uint32_t tile_groups(passes::TileDraw how, std::uint32_t step) {
    if (!how.refined) return shader::TILE * shader::TILE / passes::tile_group(how);
    const std::uint32_t across = shader::TILE / step, coarser = across / 2;
    const std::uint32_t most = step == shader::REFINE_STEP ? across * across : across * across - coarser * coarser;
    return (most + passes::tile_group(how) - 1) / passes::tile_group(how);
}

void fill_todo(const FramePlan& plan, const TargetResources& targets) {
    const glm::ivec2 tiles = plan.params.tiles, size = plan.params.size;
    const auto step = static_cast<int>(plan.refined ? shader::REFINE_STEP : 1);
    const auto todo = targets.tile_todo.mapped<std::uint32_t>(tile_count(plan));
    constexpr int kTile = static_cast<int>(shader::TILE);
    for (int y = 0, tile = 0; y < tiles.y; ++y) {
        for (int x = 0; x < tiles.x; ++x, ++tile) {
            const glm::ivec2 pixels = glm::min(glm::ivec2(kTile), size - kTile * glm::ivec2(x, y));
            const glm::ivec2 drawn = (pixels + step - 1) / step;
            todo[static_cast<std::size_t>(tile)] = static_cast<std::uint32_t>(drawn.x * drawn.y);
        }
    }
}

std::span<const std::uint32_t> sheet_pairs(const FramePlan& plan, const TargetResources& targets) {
    return targets.sheet_pairs.mapped<std::uint32_t>(plan.params.sheet_count);
}

std::span<const std::uint32_t> sheet_starts(const FramePlan& plan, const TargetResources& targets) {
    return targets.sheet_starts.mapped<std::uint32_t>(std::size_t{plan.params.sheet_count} + 1);
}

Chunks chunks_of(const FramePlan& plan, const TargetResources& targets, const glm::uvec2& sheets,
                 const gpu::DeviceProfile& profile) {
    const auto& p = plan.params;
    const auto starts = sheet_starts(plan, targets);
    const std::size_t count = sheets.y - sheets.x;
    Chunks chunks =
        plan_chunks(sheet_pairs(plan, targets).subspan(sheets.x, count), starts.subspan(sheets.x, count + 1),
                    chunk_pairs(p.tiles, profile), std::uint64_t{p.prepared_mask} + 1);
    chunks.sheets = sheets;
    chunks.entries = starts[sheets.y] - starts[sheets.x];
    return chunks;
}

bool worth_refining(const Chunks& chunks) {
    // Splats that are few pixels wide are as many for the eight pixels that are drawn together, wherever those lie.
    // Those of voxels as wide as the first step, 12.8 pixels across, touch 1.8 x 1.8 tiles.
    return 4 * chunks.pairs > 13 * chunks.entries;
}

std::uint64_t tile_order_items(const FramePlan& plan) {
    const std::uint64_t items =
        tile_count(plan) * tile_groups({.profile = &gpu::device_profiles().front(), .refined = plan.refined}, 1);
    return tile_count(plan) + items + items / 65535 + 1;  // groups_for() may make so many groups too many
}

std::uint64_t tile_entry_pairs(const FramePlan& plan, const gpu::DeviceProfile& profile) {
    return padded_pairs(chunk_pairs(plan.params.tiles, profile), plan.params.tiles) * (plan.refined ? 2 : 1);
}

std::uint64_t tile_mark_words(const FramePlan& plan, std::uint64_t pairs) {
    // A picture that is planned to be refined may be drawn whole; then fewer lists are kept.
    const std::uint64_t cells = plan.wide_marks ? shader::TILE * shader::TILE / 8 : shader::TILE * shader::TILE;
    return padded_pairs(pairs, plan.params.tiles) *
           std::max(cells / shader::MARKED_AT_ONCE, std::uint64_t{plan.refined ? 2U : 1U});
}

std::uint32_t first_step(const FramePlan& plan) {
    return plan.refined ? shader::REFINE_STEP : 1;
}

}  // namespace edgesplat
