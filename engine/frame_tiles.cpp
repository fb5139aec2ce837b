#include "engine/frame_tiles.h"

#include <algorithm>
#include <functional>
#include <numeric>

#include "engine/frame.h"
#include "engine/passes/3_select_footprints.h"
#include "engine/passes/4_prepare_splats.h"
#include "engine/passes/4_sort_sheets.h"
#include "engine/passes/4_sort_tiles.h"
#include "engine/passes/7_resolve.h"

namespace edgesplat {

std::uint64_t chunk_pairs(const glm::ivec2& tiles) {
    const auto count = static_cast<std::uint64_t>(tiles.x) * static_cast<std::uint64_t>(tiles.y);
    const std::uint64_t most = std::uint64_t{tile_blocks(tiles)} * shader::BLOCK_PAIRS;
    return std::min(most, std::max(256 * count, std::uint64_t{1} << 14U));
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

Chunks sort_frame(gpu::Commands& commands, const FramePlan& plan, const TargetResources& targets,
                  const Division& division) {
    const auto& p = plan.params;
    commands.run([&] {
        for (const gpu::Buffer* zeroed :
             {&targets.counters, &targets.sheet_pairs, &targets.tile_closed, &targets.output})
            commands.raw().fillBuffer(zeroed->handle(), 0, VK_WHOLE_SIZE, 0);
        commands.barrier();
        commands.span("3_select_footprints", [&] { passes::select_footprints(commands, p.splat_count, plan.variant); });
        commands.span("4_sort_sheets",
                      [&] { passes::sort_sheets(commands, plan.variant.sliced, true, plan.sort_segments); });
    });
    const auto pairs = targets.sheet_pairs.mapped<std::uint32_t>(p.sheet_count);
    const auto starts = targets.sheet_starts.mapped<std::uint32_t>(std::size_t{p.sheet_count} + 1);
    const glm::uvec2 sheets = division.sheets(pairs, p.sheet_base);
    const std::size_t count = sheets.y - sheets.x;
    Chunks chunks = plan_chunks(pairs.subspan(sheets.x, count), starts.subspan(sheets.x, count + 1),
                                chunk_pairs(p.tiles), std::uint64_t{p.prepared_mask} + 1);
    chunks.sheets = sheets;
    return chunks;
}

namespace {

/// Tiles by the length of their lists, so that a round goes to those alone that it has something for.
class TileOrder {
  public:
    TileOrder(const shader::FrameParams& p, const TargetResources& targets, bool rounds)
        : count_(static_cast<std::size_t>(p.tiles.x) * static_cast<std::size_t>(p.tiles.y)) {
        if (!rounds) return;
        ranges_ = targets.tile_ranges.mapped<glm::uvec2>(count_);
        order_ = targets.tile_order.mapped<std::uint32_t>(count_);
        listed_ = 0;
    }

    /// After a chunk's lists were made.
    void sort() {
        std::iota(order_.begin(), order_.end(), 0U);
        const auto empty =
            std::partition(order_.begin(), order_.end(), [&](std::uint32_t tile) { return length(tile) > 0; });
        listed_ = static_cast<std::size_t>(empty - order_.begin());
        std::ranges::sort(order_.first(listed_), std::greater{}, [&](std::uint32_t tile) { return length(tile); });
    }

    /// Tiles whose lists go on in that round of TILE_ROUND entries: the first so many.
    std::size_t in_round(std::uint32_t round) const {
        if (order_.empty()) return count_;
        const auto some = order_.first(listed_);
        const auto done = std::ranges::lower_bound(some, round * shader::TILE_ROUND, std::greater{},
                                                   [&](std::uint32_t tile) { return length(tile); });
        return static_cast<std::size_t>(done - some.begin());
    }

  private:
    std::uint32_t length(std::uint32_t tile) const { return ranges_[tile].y - ranges_[tile].x; }
    std::size_t count_, listed_ = 0;
    std::span<const glm::uvec2> ranges_;
    std::span<std::uint32_t> order_;
};

}  // namespace

std::vector<PassTime> draw_frame(gpu::Commands& commands, const FramePlan& plan, const TargetResources& targets,
                                 std::uint32_t chunks, passes::TileDraw how, const std::function<void()>& between) {
    const auto& p = plan.params;
    const auto parts = targets.chunks.mapped<glm::uvec2>(chunks);
    const auto pairs = targets.sheet_pairs.mapped<std::uint32_t>(p.sheet_count);
    const auto starts = targets.sheet_starts.mapped<std::uint32_t>(std::size_t{p.sheet_count} + 1);
    const auto sort = [&](std::uint32_t chunk) {
        const std::uint64_t most = most_column_pairs(parts[chunk], p.tile_blocks, pairs, starts);
        const auto steps = static_cast<std::uint32_t>((most + shader::PAIR_STEPS - 1) / shader::PAIR_STEPS);
        commands.span("4_sort_tiles",
                      [&] { passes::sort_tiles(commands, targets.tile_counters, p.tile_blocks, chunk, steps); });
    };
    TileOrder order(p, targets, how.rounds);
    // A sheet of very many splats is drawn from the splats themselves.
    const auto entries = [&](std::uint32_t chunk) { return parts[chunk].y - parts[chunk].x; };
    const auto is_prepared = [&](std::uint32_t chunk) { return entries(chunk) <= p.prepared_mask + 1; };
    const auto prepare = [&](std::uint32_t chunk) {
        if (!is_prepared(chunk)) return;
        commands.span("4_prepare_splats",
                      [&] { passes::prepare_splats(commands, plan.variant, chunk, entries(chunk)); });
    };
    const auto draw = [&](std::uint32_t chunk, std::uint32_t round) {
        passes::TileDraw of_chunk = how;
        of_chunk.prepared = is_prepared(chunk);
        commands.span("5_draw_tiles",
                      [&] { passes::draw_tiles(commands, plan.variant, order.in_round(round), of_chunk, round); });
    };
    const auto resolve = [&] {
        if (how.part) return;
        commands.span("7_resolve", [&] { passes::resolve(commands, plan.variant, plan.params.size, plan.gradient); });
    };
    std::ranges::fill(targets.drawn.mapped<std::uint32_t>(4).last(2), 0U);
    if (!how.rounds) {
        commands.run([&] {
            for (std::uint32_t chunk = 0; chunk < chunks; ++chunk) {
                sort(chunk);
                prepare(chunk);
                draw(chunk, 0);
            }
            resolve();
        });
        return commands.span_times();
    }
    std::vector<PassTime> times;
    for (std::uint32_t chunk = 0; chunk <= chunks; ++chunk) {
        std::uint32_t round = 0;
        for (; between && order.in_round(round) > 0; ++round) {
            commands.run([&] { draw(chunk - 1, round); });
            add_times(times, commands.span_times());
            between();
        }
        commands.run([&] {
            for (; order.in_round(round) > 0; ++round)
                draw(chunk - 1, round);
            if (chunk < chunks) {
                sort(chunk);
                prepare(chunk);
            } else {
                resolve();
            }
        });
        order.sort();
        add_times(times, commands.span_times());
    }
    return times;
}

std::vector<PassTime> resolve_frame(gpu::Commands& commands, const FramePlan& plan) {
    commands.run([&] {
        commands.span("7_resolve", [&] { passes::resolve(commands, plan.variant, plan.params.size, plan.gradient); });
    });
    return commands.span_times();
}

}  // namespace edgesplat
