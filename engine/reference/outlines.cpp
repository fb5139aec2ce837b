#include "engine/reference/outlines.h"

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

/// A picture with one ray a pixel, and its outlines.
struct OutlinedPicture {
    std::span<const vec4> frame;
    std::span<const std::optional<reference::Outline>> outlines;
    ivec2 size;

    std::size_t place(const ivec2& pixel) const {
        const ivec2 held = clamp(pixel, ivec2(0), size - 1);
        return static_cast<std::size_t>(held.y) * static_cast<std::size_t>(size.x) + static_cast<std::size_t>(held.x);
    }
    vec4 drawn_at(const ivec2& pixel) const { return frame[place(pixel)]; }
    vec2 outline_offset(const ivec2& pixel) const {
        const auto& outline = outlines[place(pixel)];
        if (!outline || pixel != clamp(pixel, ivec2(0), size - 1)) return vec2(0);
        return outline->down ? vec2(0, outline->offset) : vec2(outline->offset, 0);
    }
#include "engine/geometry/pixel_outline.glsl"
};

}  // namespace
}  // namespace edgesplat::geometry

namespace edgesplat::reference {
namespace {

using glm::dvec2;
using glm::dvec3;
using glm::dvec4;

/// The outline where `level` is 0; matter lies where it is negative. `rate`: change of `level` per pixel. nullopt if
/// the outline is a pixel or more away.
std::optional<Outline> outline_of_rate(double level, const dvec2& rate) {
    const geometry::OutlinePlace place = geometry::outline_place(level, rate);
    if (!place.there) return {};
    return Outline{place.level, place.offset, place.down};
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
    geometry::OutlinedPicture picture{frame, outlines, {width, height}};
    std::vector<dvec4> out;
    out.reserve(frame.size());
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
            out.push_back(picture.with_other_side(picture.drawn_at({x, y}), {x, y}));
    return out;
}

}  // namespace edgesplat::reference
