#include "engine/distribute/parts.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "shaders/shared/limits.h"

namespace edgesplat {
namespace {

constexpr double kMostSheets = 2e9;

/// Smallest and largest depth of a box of voxels, mm along the view.
glm::dvec2 depths_of(const VolumeGeometry& geometry, const CameraFrame& view, const glm::dvec3& low,
                     const glm::dvec3& high) {
    glm::dvec2 depths(std::numeric_limits<double>::max(), std::numeric_limits<double>::lowest());
    for (int corner = 0; corner < 8; ++corner) {
        const glm::dvec3 at = glm::mix(low, high, glm::bvec3((corner & 1) != 0, (corner & 2) != 0, (corner & 4) != 0));
        const double z = glm::dot(view.forward, geometry.to_world(at) - view.eye);
        depths = {std::min(depths.x, z), std::max(depths.y, z)};
    }
    return depths;
}

int sheet_at(double depth, double thickness) {
    return static_cast<int>(std::clamp(std::floor(depth / thickness), 0.0, kMostSheets));
}

}  // namespace

glm::ivec2 sheets_of_block(const VolumeGeometry& geometry, const Camera& camera, double thickness, double reach,
                           const CollectionBlock& block) {
    const glm::dvec3 low(block.core_low), high(block.core_low + block.core_size - 1);
    const glm::dvec2 depths = depths_of(geometry, camera_frame(camera), low - reach, high + reach);
    // One more on either side for the device's rounding.
    return {std::max(sheet_at(depths.x, thickness) - 1, 0), sheet_at(depths.y, thickness) + 2};
}

glm::ivec2 slab_of_part(const VolumeGeometry& geometry, const Camera& camera, double thickness,
                        std::span<const CollectionBlock> blocks, const SheetPart& part) {
    struct Span {
        double from, to, voxels;
    };
    const CameraFrame view = camera_frame(camera);
    std::vector<Span> spans;
    double farthest = 0;
    for (const CollectionBlock& block : blocks) {
        const glm::dvec3 low(block.core_low), size(block.core_size);
        const glm::dvec2 depths = depths_of(geometry, view, low - 0.5, low + size - 0.5);
        if (!(depths.y > 0)) continue;
        const double from = std::max(depths.x, 0.0);
        spans.push_back({from, depths.y, size.x * size.y * size.z * (depths.y - from) / (depths.y - depths.x)});
        farthest = std::max(farthest, depths.y);
    }
    const auto voxels_before = [&](double depth) {
        double sum = 0;
        for (const Span& s : spans)
            sum += s.voxels * std::clamp((depth - s.from) / (s.to - s.from), 0.0, 1.0);
        return sum;
    };
    const double all = voxels_before(farthest);
    // The first sheet behind the share of the parts before `index`.
    const auto begin = [&](int index) {
        int low = 0, high = sheet_at(farthest, thickness) + 1;
        while (low < high) {
            const int middle = low + (high - low) / 2;
            const bool enough = voxels_before(middle * thickness) * part.count >= all * index;
            (enough ? high : low) = enough ? middle : middle + 1;
        }
        return low;
    };
    return {part.index == 0 ? 0 : begin(part.index),
            part.index + 1 == part.count ? std::numeric_limits<int>::max() : begin(part.index + 1)};
}

glm::uvec2 Division::sheets(std::span<const std::uint32_t> pairs, int base) const {
    if (!slab) return sheets_of_part(pairs, part);
    const auto last = static_cast<std::int64_t>(pairs.size());
    const auto counted = [&](int number) {
        return static_cast<std::uint32_t>(std::clamp<std::int64_t>(std::int64_t{number} - base, 0, last));
    };
    return {counted(slab->x), counted(slab->y)};
}

glm::uvec2 sheets_of_part(std::span<const std::uint32_t> pairs, const SheetPart& part) {
    const auto sheets = static_cast<std::uint32_t>(pairs.size());
    const std::uint64_t all = std::accumulate(pairs.begin(), pairs.end(), std::uint64_t{0});
    // A part begins with the first sheet whose middle pair lies behind the share of the parts in front.
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

std::vector<std::uint32_t> PixelsBehind::closed_pixels(const glm::ivec2& size, const glm::ivec2& tiles,
                                                       std::span<const std::uint32_t> drawn) const {
    constexpr int kTile = static_cast<int>(shader::TILE);
    std::vector<std::uint32_t> closed(drawn.begin(), drawn.end());
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
