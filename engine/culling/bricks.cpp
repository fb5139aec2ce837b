#include "engine/culling/bricks.h"

namespace edgesplat {
namespace {

constexpr std::size_t kFanout = 8;

}  // namespace

void SplatBricks::assign(std::vector<SplatBrick> bricks) {
    levels_.clear();
    std::erase_if(bricks, [](const SplatBrick& brick) { return brick.count == 0; });
    if (bricks.empty()) return;
    levels_.push_back(std::move(bricks));
    while (levels_.back().size() > 1) {
        const auto& below = levels_.back();
        std::vector<SplatBrick> above((below.size() + kFanout - 1) / kFanout);
        for (std::size_t i = 0; i < below.size(); ++i) {
            SplatBrick& node = above[i / kFanout];
            if (node.count == 0) node.first = below[i].first;
            node.count += below[i].count;
            node.box.add(below[i].box);
        }
        levels_.push_back(std::move(above));
    }
}

std::span<const SplatBrick> SplatBricks::bricks() const {
    return levels_.empty() ? std::span<const SplatBrick>() : levels_.front();
}

std::vector<std::uint32_t> SplatBricks::in_view(const ViewVolume& view, double reach) const {
    std::vector<std::uint32_t> numbers;
    if (!levels_.empty()) add_in_view(view, reach, levels_.size() - 1, 0, numbers);
    return numbers;
}

void SplatBricks::add_in_view(const ViewVolume& view, double reach, std::size_t level, std::size_t node,
                              std::vector<std::uint32_t>& numbers) const {
    const SplatBrick& here = levels_[level][node];
    const glm::ivec3 size = here.box.size();
    if (!view.shows(here.box.low, size, reach)) return;
    if (level > 0 && !view.holds(here.box.low, size, reach)) {
        const std::size_t end = std::min((node + 1) * kFanout, levels_[level - 1].size());
        for (std::size_t child = node * kFanout; child < end; ++child)
            add_in_view(view, reach, level - 1, child, numbers);
        return;
    }
    std::size_t first = node, end = node + 1;
    for (std::size_t above = level; above > 0; --above) {
        first *= kFanout;
        end = std::min(end * kFanout, levels_[above - 1].size());
    }
    for (std::size_t i = first; i < end; ++i)
        numbers.push_back(static_cast<std::uint32_t>(i));
}

std::vector<ListPart> SplatBricks::parts_of(std::span<const std::uint32_t> numbers, std::uint32_t least_gap) const {
    std::vector<ListPart> parts;
    for (const std::uint32_t number : numbers) {
        const SplatBrick& brick = levels_.front()[number];
        if (!parts.empty() && brick.first - parts.back().end < least_gap)
            parts.back().end = brick.first + brick.count;
        else
            parts.push_back({brick.first, brick.first + brick.count});
    }
    return parts;
}

std::vector<glm::uvec2> batches_of(std::span<const ListPart> parts) {
    std::vector<glm::uvec2> batches;
    for (const ListPart& part : parts)
        for (std::uint32_t first = part.first; first < part.end; first += shader::SPLAT_BATCH)
            batches.emplace_back(first, std::min(part.end - first, shader::SPLAT_BATCH));
    return batches;
}

}  // namespace edgesplat
