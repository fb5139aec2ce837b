#include "engine/compositors/tiles/tiles.h"

#include <algorithm>
#include <bit>
#include <functional>
#include <numeric>

#include "engine/compositors/tiles/lists.h"
#include "engine/frame/frame.h"
#include "engine/passes/3_select_footprints.h"
#include "engine/passes/4_mark_pixels.h"
#include "engine/passes/4_prepare_splats.h"
#include "engine/passes/4_sort_sheets.h"
#include "engine/passes/4_sort_tiles.h"
#include "engine/passes/5_refine_pixels.h"
#include "engine/passes/7_resolve.h"

namespace edgesplat {

std::uint64_t chunk_pairs(const glm::ivec2& tiles) {
    const auto count = static_cast<std::uint64_t>(tiles.x) * static_cast<std::uint64_t>(tiles.y);
    const std::uint64_t most = std::uint64_t{tile_blocks(tiles)} * shader::BLOCK_PAIRS;
    return std::min(most, std::max(256 * count, std::uint64_t{1} << 12U));
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

namespace {

/// Groups of invocations for the most pixels that a tile draws at once, after that step of a refined picture.
std::uint32_t tile_groups(passes::TileDraw how, std::uint32_t step) {
    if (!how.refined) return 1;
    const std::uint32_t across = shader::TILE / step, coarser = across / 2;
    const std::uint32_t most = step == shader::REFINE_STEP ? across * across : across * across - coarser * coarser;
    return (most + passes::tile_group(how) - 1) / passes::tile_group(how);
}

/// How many pixels of each tile are drawn first.
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

}  // namespace

bool worth_refining(const Chunks& chunks) {
    // Splats that are few pixels wide are as many for the eight pixels that are drawn together, wherever those lie.
    // Those of voxels as wide as the first step, 12.8 pixels across, touch 1.8 x 1.8 tiles.
    return 4 * chunks.pairs > 13 * chunks.entries;
}

std::uint64_t tile_order_items(const FramePlan& plan) {
    const std::uint64_t items = tile_count(plan) * tile_groups({.rounds = true, .refined = plan.refined}, 1);
    return tile_count(plan) + items + items / 65535 + 1;  // groups_for() may make so many groups too many
}

std::uint64_t tile_entry_pairs(const FramePlan& plan) {
    return padded_pairs(chunk_pairs(plan.params.tiles), plan.params.tiles) * (plan.refined ? 2 : 1);
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

Chunks sort_frame(gpu::Commands& commands, const FramePlan& plan, const TargetResources& targets,
                  const Division& division) {
    const auto& p = plan.params;
    commands.run([&] {
        for (const gpu::Buffer* zeroed : {&targets.counters, &targets.sheet_pairs})
            commands.fill(*zeroed, 0);
        if (!division.goes_on)
            for (const gpu::Buffer* zeroed : {&targets.tile_closed, &targets.output})
                commands.fill(*zeroed, 0);
        if (plan.refined) commands.fill(targets.tile_finest, std::bit_cast<std::uint32_t>(1e30F));
        commands.barrier();
        commands.span("3_select_footprints", [&] { passes::select_footprints(commands, p.slot_count, plan.variant); });
        commands.span("4_sort_sheets", [&] { passes::sort_sheets(commands, plan.variant, plan.sort_segments); });
    });
    const auto pairs = targets.sheet_pairs.mapped<std::uint32_t>(p.sheet_count);
    const auto starts = targets.sheet_starts.mapped<std::uint32_t>(std::size_t{p.sheet_count} + 1);
    const glm::uvec2 sheets = division.sheets(pairs, p.sheet_base);
    const std::size_t count = sheets.y - sheets.x;
    Chunks chunks = plan_chunks(pairs.subspan(sheets.x, count), starts.subspan(sheets.x, count + 1),
                                chunk_pairs(p.tiles), std::uint64_t{p.prepared_mask} + 1);
    chunks.sheets = sheets;
    chunks.entries = starts[sheets.y] - starts[sheets.x];
    return chunks;
}

namespace {

/// A tiled frame from its chunks on: for a device that takes it all at once, and for one that must be given rounds.
class TileFrame {
  public:
    TileFrame(gpu::Commands& commands, const FramePlan& plan, const TargetResources& targets, std::uint32_t chunks,
              passes::TileDraw how, std::uint32_t first, std::uint32_t last)
        : commands_(commands),
          plan_(plan),
          targets_(targets),
          how_(how),
          first_(first),
          last_(last),
          parts_(targets.chunks.mapped<glm::uvec2>(chunks)),
          prepared_(chunks) {
        how_.refined = plan.refined;
        how_.wide_marks = plan.wide_marks;
    }

    std::vector<PassTime> at_once() {
        commands_.run([&] {
            for (std::uint32_t step = first_; step >= last_; step /= 2) {
                const std::uint32_t groups = tile_groups(how_, step);
                for (std::uint32_t chunk = 0; chunk < parts_.size(); ++chunk) {
                    // The lists of a single chunk stand until the picture is there.
                    if (step == first_ || parts_.size() > 1) sort(chunk);
                    prepare(chunk);
                    mark(chunk, tile_count(plan_), 0);
                    draw(chunk, step, tile_count(plan_) * groups, 0);
                }
                finish(step);
            }
        });
        return commands_.span_times();
    }

    std::vector<PassTime> in_rounds(const std::function<void()>& between) {
        std::vector<PassTime> times;
        const auto run = [&](const auto& body) {
            commands_.run(body);
            add_times(times, commands_.span_times());
        };
        TileOrder order(plan_, targets_, passes::tile_group(how_));
        KeptLists kept(plan_, targets_, parts_.size());
        for (std::uint32_t step = first_; step >= last_; step /= 2) {
            order.clear();
            const auto count = order.any_todo() ? static_cast<std::uint32_t>(parts_.size()) : 0U;
            for (std::uint32_t chunk = 0; chunk <= count; ++chunk) {
                std::uint32_t round = 0;
                const auto draw_round = [&] {
                    if (round == 0) prepare(chunk - 1);
                    mark(chunk - 1, order.tiles_in(round), round);
                    draw(chunk - 1, step, order.groups_in(round), round);
                    ++round;
                };
                while (between && order.groups_in(round) > 0) {
                    run([&] {
                        draw_round();
                        see_tiles();
                    });
                    between();
                }
                const auto draw_rest = [&] {
                    while (order.groups_in(round) > 0)
                        draw_round();
                };
                if (chunk == count) {
                    run([&] {
                        draw_rest();
                        finish(step);
                    });
                    break;
                }
                // Whether lists that were kept still serve is seen once the chunk before is drawn, and others lie
                // elsewhere.
                if (how_.refined && order.groups_in(round) > 0) {
                    run([&] {
                        draw_rest();
                        see_tiles();
                    });
                }
                if (!how_.refined || !kept.take(chunk)) {
                    if (how_.refined) kept.place(chunk, padded_pairs(most_pairs(chunk), plan_.params.tiles));
                    run([&] {
                        draw_rest();
                        sort(chunk);
                        see_tiles();
                    });
                    if (how_.refined) kept.keep(chunk);
                }
                order.sort(tile_groups(how_, step));
            }
        }
        return times;
    }

  private:
    std::uint32_t entries(std::uint32_t chunk) const { return parts_[chunk].y - parts_[chunk].x; }
    /// A sheet of very many splats is drawn from the splats themselves.
    bool is_prepared(std::uint32_t chunk) const { return entries(chunk) <= plan_.params.prepared_mask + 1; }

    std::span<const std::uint32_t> pairs() const {
        return targets_.sheet_pairs.mapped<std::uint32_t>(plan_.params.sheet_count);
    }
    std::span<const std::uint32_t> starts() const {
        return targets_.sheet_starts.mapped<std::uint32_t>(std::size_t{plan_.params.sheet_count} + 1);
    }
    std::uint64_t most_pairs(std::uint32_t chunk) const {
        return most_column_pairs(parts_[chunk], 1, pairs(), starts());
    }

    void sort(std::uint32_t chunk) {
        const std::uint32_t blocks = plan_.params.tile_blocks;
        const std::uint64_t most = most_column_pairs(parts_[chunk], blocks, pairs(), starts());
        const auto steps = static_cast<std::uint32_t>((most + shader::PAIR_STEPS - 1) / shader::PAIR_STEPS);
        if (how_.refined) {
            const std::uint64_t first = targets_.frame.mapped<shader::FrameParams>(1)[0].entries_first;
            const std::uint64_t room = padded_pairs(most_pairs(chunk), plan_.params.tiles);
            commands_.fill(targets_.tile_marks, ~0U, first * sizeof(std::uint32_t), room * sizeof(std::uint32_t));
            commands_.barrier();
        }
        commands_.span("4_sort_tiles",
                       [&] { passes::sort_tiles(commands_, targets_.tile_counters, blocks, chunk, steps); });
    }

    /// Unless the chunk's splats still are.
    void prepare(std::uint32_t chunk) {
        if (!is_prepared(chunk) || prepared_[chunk]) return;
        // Places are taken in turn.
        if (parts_.back().y - parts_.front().x > plan_.params.prepared_mask + 1)
            std::fill(prepared_.begin(), prepared_.end(), false);
        prepared_[chunk] = true;
        commands_.span("4_prepare_splats",
                       [&] { passes::prepare_splats(commands_, plan_.variant, chunk, entries(chunk)); });
    }

    void mark(std::uint32_t chunk, std::uint64_t tiles, std::uint32_t round) {
        passes::TileDraw of_chunk = how_;
        of_chunk.prepared = is_prepared(chunk);
        commands_.span("4_mark_pixels", [&] { passes::mark_pixels(commands_, plan_.variant, of_chunk, tiles, round); });
    }

    void draw(std::uint32_t chunk, std::uint32_t step, std::uint64_t groups, std::uint32_t round) {
        passes::TileDraw of_chunk = how_;
        of_chunk.prepared = is_prepared(chunk);
        commands_.span("5_draw_tiles", [&] {
            passes::draw_tiles(commands_, plan_.variant, of_chunk,
                               {.groups = groups,
                                .round = round,
                                .tile_groups = tile_groups(how_, step),
                                .first_pixels = how_.refined && step == shader::REFINE_STEP});
        });
    }

    /// For the host: pixels of tiles that take no more.
    void see_tiles() {
        if (!how_.refined) return;
        commands_.copy(targets_.tile_closed, targets_.tiles_seen, {{0, 0, tile_count(plan_) * sizeof(std::uint32_t)}});
        commands_.barrier();
    }

    /// After the pixels of a step.
    void finish(std::uint32_t step) {
        if (first_ == last_ && how_.part) return;
        if (step > 1) {
            commands_.span("5_refine_pixels", [&] { passes::refine_pixels(commands_, tile_count(plan_), step); });
            see_tiles();
        } else if (!how_.part) {
            commands_.span("7_resolve",
                           [&] { passes::resolve(commands_, plan_.variant, plan_.params.size, plan_.gradient); });
        }
    }

    gpu::Commands& commands_;
    const FramePlan& plan_;
    const TargetResources& targets_;
    passes::TileDraw how_;
    std::uint32_t first_, last_;  ///< steps
    std::span<const glm::uvec2> parts_;
    std::vector<bool> prepared_;  ///< chunks whose splats are
};

}  // namespace

std::vector<PassTime> draw_frame(gpu::Commands& commands, const FramePlan& plan, const TargetResources& targets,
                                 std::uint32_t chunks, passes::TileDraw how, const std::function<void()>& between) {
    std::ranges::fill(targets.drawn.mapped<std::uint32_t>(3).last(2), 0U);
    fill_todo(plan, targets);
    TileFrame frame(commands, plan, targets, chunks, how, first_step(plan), 1);
    return how.rounds ? frame.in_rounds(between) : frame.at_once();
}

std::vector<PassTime> draw_step(gpu::Commands& commands, const FramePlan& plan, const TargetResources& targets,
                                std::uint32_t chunks, passes::TileDraw how, std::uint32_t step) {
    std::ranges::fill(targets.drawn.mapped<std::uint32_t>(3).last(2), 0U);
    if (step == first_step(plan)) fill_todo(plan, targets);
    how.part = true;
    TileFrame frame(commands, plan, targets, chunks, how, step, step);
    return how.rounds ? frame.in_rounds({}) : frame.at_once();
}

std::vector<PassTime> refine_frame(gpu::Commands& commands, const FramePlan& plan, std::uint32_t step) {
    commands.run(
        [&] { commands.span("5_refine_pixels", [&] { passes::refine_pixels(commands, tile_count(plan), step); }); });
    return commands.span_times();
}

std::vector<PassTime> resolve_frame(gpu::Commands& commands, const FramePlan& plan) {
    commands.run([&] {
        commands.span("7_resolve", [&] { passes::resolve(commands, plan.variant, plan.params.size, plan.gradient); });
    });
    return commands.span_times();
}

}  // namespace edgesplat
