#include "engine/frame_tiles.h"

#include <algorithm>

#include "engine/frame.h"
#include "engine/passes/3_select_footprints.h"
#include "engine/passes/4_sort_sheets.h"
#include "engine/passes/4_sort_tiles.h"
#include "engine/passes/7_resolve.h"

namespace edgesplat {

std::uint64_t chunk_pairs(const glm::ivec2& tiles) {
    const auto count = static_cast<std::uint64_t>(tiles.x) * static_cast<std::uint64_t>(tiles.y);
    const std::uint64_t most = std::uint64_t{tile_blocks(tiles)} * shader::BLOCK_PAIRS;
    return std::min(most, std::max(256 * count, std::uint64_t{1} << 14U));
}

Chunks plan_chunks(std::span<const std::uint32_t> pairs, std::span<const std::uint32_t> starts, std::uint64_t limit) {
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
        if (sum > 0 && sum + pairs[sheet] > limit) close(starts[sheet]);
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
    Chunks chunks =
        plan_chunks(pairs.subspan(sheets.x, count), starts.subspan(sheets.x, count + 1), chunk_pairs(p.tiles));
    chunks.sheets = sheets;
    return chunks;
}

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
    const auto draw = [&](std::uint32_t round) {
        commands.span("5_draw_tiles",
                      [&] { passes::draw_tiles(commands, plan.variant, plan.params.tiles, how, round); });
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
                draw(0);
            }
            resolve();
        });
        return commands.span_times();
    }
    std::vector<PassTime> times;
    std::uint32_t longest = 0;
    for (std::uint32_t chunk = 0; chunk <= chunks; ++chunk) {
        std::uint32_t round = 0;
        for (; between && round * shader::TILE_ROUND < longest; ++round) {
            commands.run([&] { draw(round); });
            add_times(times, commands.span_times());
            between();
        }
        commands.run([&] {
            for (; round * shader::TILE_ROUND < longest; ++round)
                draw(round);
            if (chunk < chunks)
                sort(chunk);
            else
                resolve();
        });
        longest = targets.drawn.mapped<std::uint32_t>(4)[1];
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
