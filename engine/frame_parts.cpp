#include "engine/frame_parts.h"

#include <algorithm>
#include <numeric>

#include "shaders/shared/limits.h"

namespace edgesplat {

glm::uvec2 sheets_of_part(std::span<const std::uint32_t> pairs, const SheetPart& part) {
    const auto sheets = static_cast<std::uint32_t>(pairs.size());
    const std::uint64_t all = std::accumulate(pairs.begin(), pairs.end(), std::uint64_t{0});
    // A part begins with the first sheet whose middle lies beyond the part's share of all pairs.
    const auto begin = [&](int index) {
        if (index == 0) return 0U;
        std::uint64_t before = 0;
        std::uint32_t sheet = 0;
        for (; sheet < sheets; ++sheet) {
            const auto count = static_cast<std::uint64_t>(part.count);
            if ((2 * before + pairs[sheet]) * count > 2 * all * static_cast<std::uint64_t>(index)) break;
            before += pairs[sheet];
        }
        return sheet;
    };
    return {begin(part.index), part.index + 1 == part.count ? sheets : begin(part.index + 1)};
}

PixelsBehind::PixelsBehind(std::span<const float> in_front, float saturation, std::span<glm::vec4> part,
                           std::span<glm::vec4> pixels) {
    for (std::size_t i = 0; i < part.size(); ++i) {
        const float opacity = 1.0F - in_front[i];
        pixels[i] = glm::vec4(0, 0, 0, 1);
        if (opacity >= saturation) {
            part[i] = glm::vec4(0);
        } else if (opacity > 0 && opacity + in_front[i] * part[i].a >= saturation) {
            pixels[i].a = opacity;
            again_.push_back(i);
        }
    }
}

std::vector<std::uint32_t> PixelsBehind::closed_pixels(const glm::ivec2& size, const glm::ivec2& tiles) const {
    constexpr int kTile = static_cast<int>(shader::TILE);
    std::vector<std::uint32_t> closed;
    for (int y = 0; y < tiles.y; ++y) {
        for (int x = 0; x < tiles.x; ++x) {
            const glm::ivec2 pixels = glm::min(glm::ivec2(kTile), size - kTile * glm::ivec2(x, y));
            closed.push_back(static_cast<std::uint32_t>(pixels.x * pixels.y));
        }
    }
    const auto width = static_cast<std::size_t>(size.x);
    for (const std::size_t i : again_)
        --closed[i / width / kTile * static_cast<std::size_t>(tiles.x) + i % width / kTile];
    return closed;
}

void PixelsBehind::take(std::span<const float> in_front, std::span<const glm::vec4> pixels,
                        std::span<glm::vec4> part) const {
    for (const std::size_t i : again_)
        part[i] = (pixels[i] - glm::vec4(0, 0, 0, 1.0F - in_front[i])) / in_front[i];
}

}  // namespace edgesplat
