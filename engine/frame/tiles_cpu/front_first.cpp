#include "engine/frame/tiles_cpu/front_first.h"

#include <algorithm>
#include <cmath>

#include "engine/frame/tiles/hiding.h"

namespace edgesplat {
namespace {

// Limit of the mean number of tiles per splat. Above it drawing dominates, and pixels may be refined (should_refine).
constexpr double kMostTiles = 2.6;
// Limit of the share of splats in bricks that belong to both parts. Above it drawing all at once is faster.
constexpr double kMostTwice = 0.3;

/// Sheets between two depths, numbered from the eye on, half open; one more on either side for the device's rounding.
glm::ivec2 sheets_of(const FramePlan& plan, const glm::dvec2& depths) {
    const glm::dvec2 sheets =
        glm::clamp(glm::floor(depths / static_cast<double>(plan.params.sheet_thickness)), 0.0, 1e9);
    return {std::max(static_cast<int>(sheets.x) - 1, 0), static_cast<int>(sheets.y) + 2};
}

/// Estimated number of tiles that a splat at this depth (mm) touches.
double tiles_of_splat(const FramePlan& plan, double depth) {
    const auto& p = plan.params;
    const glm::dmat3 to_world(plan.volume.index_to_world);
    const double voxel = std::max({glm::length(to_world[0]), glm::length(to_world[1]), glm::length(to_world[2])});
    const double pixels = static_cast<double>(plan.volume.support) * voxel / std::max(depth, 1e-6) * p.size.y /
                          static_cast<double>(p.tan_half_y);
    const double across = 1 + pixels / shader::TILE;
    return across * across;
}

}  // namespace

std::optional<FrontAndRest> divide_front(const FramePlan& plan, const SplatBricks& bricks, std::uint64_t least) {
    const auto& p = plan.params;
    if (plan.variant.sliced || plan.variant.antialias || p.saturation > 1 || plan.splats_examined < least ||
        plan.bricks.empty())
        return std::nullopt;
    struct Place {
        double depth;
        std::uint32_t splats;
    };
    std::vector<Place> places;
    double tiles = 0, splats = 0;
    for (const std::uint32_t number : plan.bricks) {
        const SplatBrick& brick = bricks.bricks()[number];
        const glm::dvec2 depths = depths_of(plan, brick.box);
        places.push_back({0.5 * (depths.x + depths.y), brick.count});
        tiles += brick.count * tiles_of_splat(plan, places.back().depth);
        splats += brick.count;
    }
    if (tiles > kMostTiles * splats) return std::nullopt;
    std::ranges::sort(places, {}, &Place::depth);
    double before = 0;
    const auto half =
        std::ranges::find_if(places, [&](const Place& place) { return (before += place.splats) >= 0.5 * splats; });
    double twice = 0;
    FrontAndRest out;
    out.sheet = sheets_of(plan, glm::dvec2(half->depth)).x;
    for (const std::uint32_t number : plan.bricks) {
        const glm::ivec2 sheets = sheets_of(plan, depths_of(plan, bricks.bricks()[number].box));
        const bool in_front = sheets.x<out.sheet, behind = sheets.y> out.sheet;
        if (in_front) out.front.push_back(number);
        if (behind) out.rest.push_back(number);
        if (in_front && behind) twice += bricks.bricks()[number].count;
    }
    if (twice > kMostTwice * splats) return std::nullopt;
    return out;
}

}  // namespace edgesplat
