#include "engine/frame/tiles/hiding.h"

#include <algorithm>
#include <cmath>
#include <iterator>

namespace edgesplat {
namespace {

/// A box widened by the kernels' reach: its middle relative to the anchor, and half extents, voxels.
struct WideBox {
    glm::dvec3 middle, half;
    WideBox(const FramePlan& plan, const VoxelBox& box)
        : middle(0.5 * glm::dvec3(box.low + box.high) - glm::dvec3(plan.volume.anchor)),
          half(0.5 * glm::dvec3(box.high - box.low) + plan.reach) {}
};

/// Tiles x0, y0, x1, y1, half open, that a box may show in; nullopt if it reaches the eye's plane.
std::optional<glm::ivec4> tiles_of(const FramePlan& plan, const WideBox& box) {
    const auto& p = plan.params;
    const auto& v = plan.volume;
    const glm::dvec2 size(p.size), tan_half(p.tan_half_x, p.tan_half_y);
    glm::dvec2 low(size), high(0);
    for (int corner = 0; corner < 8; ++corner) {
        const glm::bvec3 far((corner & 1) != 0, (corner & 2) != 0, (corner & 4) != 0);
        const glm::dvec3 at = box.middle + glm::mix(-box.half, box.half, far);
        const double depth = glm::dot(glm::dvec3(v.view_z), at) + static_cast<double>(v.anchor_z);
        if (!(depth > 0)) return std::nullopt;
        const glm::dvec2 view(glm::dot(glm::dvec3(v.view_x), at) + static_cast<double>(v.anchor_x),
                              glm::dot(glm::dvec3(v.view_y), at) + static_cast<double>(v.anchor_y));
        const glm::dvec2 pixel = (view / depth / tan_half * 0.5 + 0.5) * size;
        low = glm::min(low, pixel - 1.0);
        high = glm::max(high, pixel + 1.0);
    }
    constexpr double kTile = shader::TILE;
    low = glm::clamp(glm::floor(low), glm::dvec2(0), size);
    high = glm::clamp(glm::ceil(high), low, size);
    return glm::ivec4(glm::floor(low / kTile), glm::ceil(high / kTile));
}

}  // namespace

glm::dvec2 depths_of(const FramePlan& plan, const VoxelBox& voxels) {
    const WideBox box(plan, voxels);
    const glm::dvec3 z(plan.volume.view_z);
    const double middle = glm::dot(z, box.middle) + static_cast<double>(plan.volume.anchor_z);
    const double half = glm::dot(glm::abs(z), box.half);
    return {middle - half, middle + half};
}

void cull_behind(FramePlan& plan, const SplatBricks& bricks, std::span<const float> ends) {
    const auto is_seen = [&](std::uint32_t number) {
        const VoxelBox& box = bricks.bricks()[number].box;
        const auto tiles = tiles_of(plan, WideBox(plan, box));
        const double nearest = depths_of(plan, box).x;
        if (!tiles) return true;
        for (int y = tiles->y; y < tiles->w; ++y)
            for (int x = tiles->x; x < tiles->z; ++x)
                if (nearest < static_cast<double>(ends[static_cast<std::size_t>(y * plan.params.tiles.x + x)]))
                    return true;
        return false;
    };
    if (plan.bricks.empty()) return;
    std::vector<std::uint32_t> seen;
    std::ranges::copy_if(plan.bricks, std::back_inserter(seen), is_seen);
    plan.bricks = seen;
    draw_bricks(plan, bricks, seen);
}

OpenTiles::OpenTiles(const FramePlan& plan, std::span<const std::uint32_t> closed) : plan_(&plan) {
    constexpr int kTile = static_cast<int>(shader::TILE);
    const glm::ivec2 tiles = plan.params.tiles;
    open_.resize((static_cast<std::size_t>(tiles.x) + 1) * (static_cast<std::size_t>(tiles.y) + 1));
    std::size_t tile = 0;
    for (int y = 0; y < tiles.y; ++y)
        for (int x = 0; x < tiles.x; ++x, ++tile) {
            const glm::ivec2 pixels = glm::min(glm::ivec2(kTile), plan.params.size - kTile * glm::ivec2(x, y));
            const bool is_open = closed[tile] != static_cast<std::uint32_t>(pixels.x * pixels.y);
            open_[corner(x + 1, y + 1)] =
                open_[corner(x, y + 1)] + open_[corner(x + 1, y)] - open_[corner(x, y)] + (is_open ? 1U : 0U);
        }
}

bool OpenTiles::may_show(const VoxelBox& box) const {
    const auto tiles = tiles_of(*plan_, WideBox(*plan_, box));
    return !tiles || open_[corner(tiles->z, tiles->w)] + open_[corner(tiles->x, tiles->y)] !=
                         open_[corner(tiles->x, tiles->w)] + open_[corner(tiles->z, tiles->y)];
}

std::size_t OpenTiles::corner(int x, int y) const {
    return static_cast<std::size_t>(y) * (static_cast<std::size_t>(plan_->params.tiles.x) + 1) +
           static_cast<std::size_t>(x);
}

}  // namespace edgesplat
