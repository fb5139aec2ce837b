#include "engine/reference/outlines.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "engine/reference/faces.h"
#include "shaders/shared/limits.h"

namespace edgesplat::reference {
namespace {

using glm::dvec2;
using glm::dvec3;
using glm::dvec4;
using glm::ivec2;

constexpr double kStraight = 1e-6;

double not_zero(double v) {
    return std::abs(v) < kStraight ? std::copysign(kStraight, v) : v;
}

/// Change of a function with this gradient, at a depth (mm), from a pixel to its neighbours to the right and below.
dvec2 rate_across(const View& view, const dvec3& gradient, double depth) {
    const double pixel = 2 * view.frame.tan_half_y * depth / view.height;
    return pixel * dvec2(glm::dot(gradient, view.world_to_index * view.frame.right),
                         glm::dot(gradient, view.world_to_index * -view.frame.up));
}

/// The outline where `level` is 0; matter lies where it is negative. `rate`: change of `level` per pixel. nullopt if
/// the outline is a pixel or more away.
std::optional<Outline> outline_of_rate(double level, const dvec2& rate) {
    const bool down = std::abs(rate.y) > std::abs(rate.x);
    const double along = down ? rate.y : rate.x, pixels = level / std::abs(along);
    if (!(std::abs(pixels) < 1)) return {};
    return Outline{pixels, -level / along, down};
}

/// A splat along one ray.
struct OutlinedSplat {
    const VoxelEdge& edge;
    const View& view;
    FaceSight sight;
    double thickness;                ///< of a wall; else infinite
    double ahead, tau, depth_along;  ///< depth_along: mm of depth per voxel along the ray

    double depth(double z) const { return (ahead + z) * depth_along; }

    /// Whether the ray's point z lies inside a corner's third plane.
    bool inside_corner(double z) const { return sight.ray.corner.p + z * sight.ray.corner.u < edge.corner.D; }

    dvec2 rate_across(const dvec3& gradient, double z) const {
        return reference::rate_across(view, gradient, depth(z));
    }

    /// outline_of_rate(); nullopt if the splat is too faint or too far from the ray.
    std::optional<Outline> passing(double level, const dvec2& rate, double z) const {
        const double distance2 = sight.ray.rho2 + z * z;
        const bool knows = level < 0 ? tau > static_cast<double>(shader::OUTLINE_TAU) &&
                                           distance2 < static_cast<double>(shader::OUTLINE_FAR2)
                                     : distance2 < static_cast<double>(shader::OUTLINE_NEAR2);
        return knows ? outline_of_rate(level, rate) : std::nullopt;
    }

    /// The outline of a face: the ray's minimum of phi, or of a wall's other face its maximum.
    std::optional<Outline> of_face() const {
        const Quadratic& phi = sight.ray.phi;
        const bool opens = phi.a >= 0;
        if (!opens && !std::isfinite(thickness)) return {};
        const double side = opens ? 1 : -1, z = -0.5 * phi.b / not_zero(phi.a);
        if (!(depth(z) > 0) || !(sight.ray.crease.p + z * sight.ray.crease.u < edge.crease.D)) return {};
        if (!inside_corner(z)) return {};
        return passing(side * (phi.at(z) + (opens ? 0 : thickness)),
                       side * rate_across(sight.slope + z * sight.turn, z), z);
    }

    /// The outline at a crease: there the path between face and crease plane has length 0.
    std::optional<Outline> of_crease() const {
        const Quadratic& phi = sight.ray.phi;
        const FaceRoots roots = face_roots(phi, 0);
        if (!std::isfinite(edge.crease.D) || !roots.real) return {};
        const bool leaves = sight.ray.crease.u > 0;  // the ray leaves the matter through the crease's plane
        const double side = leaves ? 1 : -1, u = not_zero(sight.ray.crease.u);
        const double at_face = (phi.a >= 0) == leaves ? roots.low : roots.high;
        const double at_crease = (edge.crease.D - sight.ray.crease.p) / u, z = 0.5 * (at_face + at_crease);
        const double along = phi.b + 2 * at_face * phi.a;
        if (!(depth(z) > 0) || !(along * u < 0) || !inside_corner(z)) return {};
        const dvec2 rate =
            rate_across(edge.crease.n, z) / u - rate_across(sight.slope + at_face * sight.turn, z) / along;
        return passing(side * (at_face - at_crease), side * rate, z);
    }
};

}  // namespace

std::optional<Outline> outline_of(const VoxelEdge& edge, const View& view, const dvec3& p, const dvec3& u, double ahead,
                                  double tau) {
    const double depth_along = glm::dot(view.frame.forward, view.geometry.index_to_world_axes * u);
    const OutlinedSplat splat{edge, view,       face_sight(edge, p, u), cut_of(edge, kKernel).thickness, ahead,
                              tau,  depth_along};
    std::optional<Outline> outline = splat.of_face();
    keep_outer(outline, splat.of_crease());
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
