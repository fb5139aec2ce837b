#include "engine/frame/tiles_cpu/lists.h"

#include <algorithm>
#include <functional>

#include "engine/passes/5_draw_tiles.h"

namespace edgesplat {

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

bool should_refine(const Chunks& chunks) {
    // Refinement saves nothing for small splats: the eight separate pixels drawn together share few of them. Splats of
    // voxels as wide as the first step (4 pixels) are 12.8 pixels across and touch 1.8 x 1.8 = 3.25 tiles (13 / 4).
    return 4 * chunks.pairs > 13 * chunks.entries;
}

std::uint32_t first_step(const FramePlan& plan) {
    return plan.refined ? shader::REFINE_STEP : 1;
}

TileOrder::TileOrder(const FramePlan& plan, const TargetResources& targets, std::uint32_t group)
    : ranges_(targets.tile_ranges.mapped<glm::uvec2>(tile_count(plan))),
      todo_(targets.tile_todo.mapped<std::uint32_t>(tile_count(plan))),
      tiles_(targets.tile_order.mapped<std::uint32_t>(ranges_.size())),
      order_(targets.tile_order.mapped<std::uint32_t>(tile_order_items(plan)).subspan(ranges_.size())),
      group_(group) {
    sorted_.reserve(ranges_.size());
}

void TileOrder::sort(std::uint32_t groups) {
    clear();
    for (std::uint32_t tile = 0; tile < ranges_.size(); ++tile)
        if (length(tile) > 0 && todo_[tile] > 0) sorted_.push_back(tile);
    std::ranges::sort(sorted_, std::greater{}, [&](std::uint32_t tile) { return length(tile); });
    std::ranges::copy(sorted_, tiles_.begin());
    std::ranges::fill(tiles_.subspan(sorted_.size()), ~0U);
    std::size_t at = 0;
    for (const std::uint32_t tile : sorted_) {
        for (std::uint32_t first = 0, i = 0; first < todo_[tile]; first += group_, ++i)
            order_[at++] = tile * groups + i;
        ends_.push_back(at);
    }
    // A dispatch that is folded into rows may have surplus groups in its last row; they load these.
    std::ranges::fill(order_.subspan(at), ~0U);
}

void TileOrder::clear() {
    sorted_.clear();
    ends_.clear();
}

std::size_t TileOrder::tiles_in(std::uint32_t round) const {
    const auto done = std::ranges::lower_bound(sorted_, passes::round_begin(round), std::greater{},
                                               [&](std::uint32_t tile) { return length(tile); });
    return static_cast<std::size_t>(done - sorted_.begin());
}

std::size_t TileOrder::groups_in(std::uint32_t round) const {
    const std::size_t tiles = tiles_in(round);
    return tiles == 0 ? 0 : ends_[tiles - 1];
}

bool TileOrder::has_pixels_to_draw() const {
    return std::ranges::any_of(todo_, [](std::uint32_t pixels) { return pixels > 0; });
}

namespace {

/// Number of tile entries that every buffer with data per entry has room for. The buffers may differ: earlier pictures
/// may have enlarged only some of them.
std::uint64_t pairs_with_room(const TargetResources& targets) {
    const std::uint64_t marked =
        std::min(targets.tile_entries.bytes() / sizeof(glm::uvec2), targets.tile_marks.bytes() / sizeof(std::uint32_t));
    const std::uint64_t traced = targets.traced_entries.bytes() / sizeof(std::uint32_t) * shader::MARKED_AT_ONCE;
    return targets.traced_entries ? std::min(marked, traced) : marked;
}

}  // namespace

KeptLists::KeptLists(const FramePlan& plan, const TargetResources& targets, std::size_t chunks)
    : tiles_(tile_count(plan)), targets_(targets), lists_(chunks) {}

void KeptLists::place(std::uint32_t chunk, std::uint64_t pairs) {
    constexpr std::uint64_t kPart = shader::MARKED_AT_ONCE;
    const std::uint64_t room = pairs_with_room(targets_);
    Lists& lists = lists_[chunk];
    lists.ranges.clear();
    lists.begin = std::min(used_, room - std::min(room, pairs)) / kPart * kPart;
    for (Lists& other : lists_)
        if (other.end > lists.begin) other.ranges.clear();
    point_to(lists.begin);
}

void KeptLists::keep(std::uint32_t chunk) {
    Lists& lists = lists_[chunk];
    const auto ranges = targets_.tile_ranges.mapped<glm::uvec2>(tiles_);
    lists.ranges.assign(ranges.begin(), ranges.end());
    lists.end = lists.begin + ranges.back().y;
    lists.left_out.resize(tiles_);
    for (std::size_t tile = 0; tile < tiles_; ++tile)
        lists.left_out[tile] = is_closed(tile);
    used_ = padded_pairs(std::max(used_, lists.end), {0, 0});
}

bool KeptLists::take(std::uint32_t chunk) {
    const Lists& lists = lists_[chunk];
    if (lists.ranges.empty()) return false;
    for (std::size_t tile = 0; tile < tiles_; ++tile)
        if (lists.left_out[tile] && !is_closed(tile)) return false;
    std::ranges::copy(lists.ranges, targets_.tile_ranges.mapped<glm::uvec2>(tiles_).begin());
    point_to(lists.begin);
    return true;
}

bool KeptLists::is_closed(std::size_t tile) const {
    return targets_.tile_closed_on_host.mapped<std::uint32_t>(tiles_)[tile] ==
           targets_.tile_todo.mapped<std::uint32_t>(tiles_)[tile];
}

void KeptLists::point_to(std::uint64_t pair) const {
    targets_.frame.mapped<shader::FrameBlock>(1)[0].frame.entries_first = static_cast<std::uint32_t>(pair);
}

}  // namespace edgesplat
