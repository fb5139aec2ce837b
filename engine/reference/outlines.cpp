#include "engine/reference/outlines.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "engine/reference/face_geometry.h"
#include "shaders/shared/limits.h"

namespace edgesplat::reference {
namespace {

/// Change of a function with this gradient, at a depth (mm), from a pixel to its neighbours to the right and below.
glm::dvec2 rate_across(const View& view, const glm::dvec3& gradient, double depth) {
    const double pixel = 2 * view.frame.tan_half_y * depth / view.height;
    return pixel * glm::dvec2(glm::dot(gradient, view.world_to_index * view.frame.right),
                              glm::dot(gradient, view.world_to_index * -view.frame.up));
}

}  // namespace
}  // namespace edgesplat::reference

namespace edgesplat::geometry {
namespace {

/// The outlines of a splat in a view.
struct OutlineGeometry : FaceGeometry {
    explicit OutlineGeometry(const reference::View& of) : view(of) {}

    const reference::View& view;

    vec2 rate_across(const vec3& gradient, Real depth) const { return reference::rate_across(view, gradient, depth); }

#include "engine/geometry/outline.glsl"
};

}  // namespace
}  // namespace edgesplat::geometry

namespace edgesplat::reference {
namespace {

using glm::dvec2;
using glm::dvec3;
using glm::dvec4;
using glm::ivec2;

/// The outline where `level` is 0; matter lies where it is negative. `rate`: change of `level` per pixel. nullopt if
/// the outline is a pixel or more away.
std::optional<Outline> outline_of_rate(double level, const dvec2& rate) {
    const bool down = std::abs(rate.y) > std::abs(rate.x);
    const double along = down ? rate.y : rate.x, pixels = level / std::abs(along);
    if (!(std::abs(pixels) < 1)) return {};
    return Outline{pixels, -level / along, down};
}

}  // namespace

std::optional<Outline> outline_of(const VoxelEdge& edge, const View& view, const dvec3& p, const dvec3& u, double ahead,
                                  double tau) {
    geometry::OutlineGeometry at(view);
    at.take(edge);
    const double depth_along = glm::dot(view.frame.forward, view.geometry.index_to_world_axes * u);
    const geometry::OutlineGeometry::OutlinedSplat splat{at.face_sight(p, u), at.crease_seen(p, u), ahead, depth_along,
                                                         tau};
    const auto found = [](const geometry::OutlineGeometry::PassingOutline& passing) {
        return passing.there ? outline_of_rate(passing.level, passing.rate) : std::nullopt;
    };
    std::optional<Outline> outline = found(at.outline_of_face(splat, true));
    keep_outer(outline, found(at.outline_of_crease(splat)));
    return outline;
}

std::optional<Outline> outline_at(const View& view, const dvec3& u, double way, double level, const dvec3& gradient) {
    const double depth = way * glm::dot(view.frame.forward, view.geometry.index_to_world_axes * u);
    return outline_of_rate(level, rate_across(view, gradient, depth));
}

void keep_outer(std::optional<Outline>& kept, const std::optional<Outline>& found) {
    if (found && (!kept || found->level < kept->level)) kept = found;
}

std::vector<dvec4> smoothed(std::span<const dvec4> frame, std::span<const std::optional<Outline>> outlines, int width,
                            int height) {
    const ivec2 last(width - 1, height - 1);
    const auto place = [&](const ivec2& pixel) {
        const ivec2 held = glm::clamp(pixel, ivec2(0), last);
        return static_cast<std::size_t>(held.y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(held.x);
    };
    const auto offset_at = [&](const ivec2& pixel) {
        const auto& outline = outlines[place(pixel)];
        if (!outline || pixel != glm::clamp(pixel, ivec2(0), last)) return dvec2(0);
        return outline->down ? dvec2(0, outline->offset) : dvec2(outline->offset, 0);
    };
    std::vector<dvec4> out(frame.begin(), frame.end());
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
            const ivec2 pixel(x, y);
            const dvec2 offset = offset_at(pixel);
            ivec2 towards(0);
            double nearest = 0.5;
            for (const ivec2& step : {ivec2(1, 0), ivec2(-1, 0), ivec2(0, 1), ivec2(0, -1)}) {
                const double ours = glm::dot(offset, dvec2(step)),
                             theirs = -glm::dot(offset_at(pixel + step), dvec2(step));
                double at = 1;
                if (ours > 0)
                    at = theirs > 0 ? ours / (ours + theirs) : ours;
                else if (theirs > 0 && offset == dvec2(0))
                    at = 1 - theirs;
                if (at >= nearest) continue;
                nearest = at;
                towards = step;
            }
            const dvec4 own = frame[place(pixel)], next = frame[place(pixel + towards)], difference = next - own;
            const dvec4 here = own - frame[place(pixel - towards)], there = frame[place(pixel + 2 * towards)] - next;
            const dvec4 jump = difference - nearest * here - (1 - nearest) * there;
            out[place(pixel)] = own + (0.5 - nearest) * glm::clamp(jump, glm::min(difference, dvec4(0)),
                                                                   glm::max(difference, dvec4(0)));
        }
    }
    return out;
}

}  // namespace edgesplat::reference
