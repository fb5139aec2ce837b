#include "engine/frame/tiles/chunks.h"

#include <algorithm>

namespace edgesplat {

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

bool fit(const Chunks& chunks, const shader::FrameParams& params, std::size_t slots) {
    const auto prepared = [&](const glm::uvec2& part) { return part.y - part.x <= params.prepared_mask + 1; };
    return chunks.parts.size() <= slots && chunks.most_pairs <= params.chunk_pairs &&
           std::ranges::all_of(chunks.parts, prepared);
}

}  // namespace edgesplat
