#include "engine/viewer/handles.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "engine/volume/grid.h"

namespace edgesplat::viewer {
namespace {

std::array<glm::dvec3, 8> corners(const VolumeGeometry& geometry) {
    std::array<glm::dvec3, 8> out;
    for (std::size_t c = 0; c < out.size(); ++c) {
        const glm::dvec3 high(c & 1U, c >> 1U & 1U, c >> 2U & 1U);
        out[c] = geometry.to_world(high * glm::dvec3(geometry.dims) - 0.5);
    }
    return out;
}

void add_sides(std::vector<Handle>& handles, Handle::Kind kind, const ClipBox& box) {
    for (int axis = 0; axis < 3; ++axis)
        for (const bool high : {false, true}) {
            Handle handle{kind, static_cast<std::size_t>(2 * axis + (high ? 1 : 0)), (box.low + box.high) / 2.0,
                          glm::dvec3(0)};
            handle.place[axis] = high ? box.high[axis] : box.low[axis];
            handle.normal[axis] = high ? 1 : -1;
            handles.push_back(handle);
        }
}

void move_side(ClipBox& box, const VolumeGeometry& geometry, const Handle& handle, double millimetres) {
    const int axis = static_cast<int>(handle.index / 2);
    const ClipBox bounds = volume_box(geometry);
    const double gap = shortest_spacing(geometry) / 2;
    double &low = box.low[axis], &high = box.high[axis];
    const double wanted = handle.place[axis] + handle.normal[axis] * millimetres;
    if (handle.index % 2 == 1)
        high = std::max(std::min(wanted, std::max(bounds.high[axis], high)), low + gap);
    else
        low = std::min(std::max(wanted, std::min(bounds.low[axis], low)), high - gap);
}

}  // namespace

std::vector<Handle> clip_handles(const SceneDocument& document, const VolumeGeometry& geometry) {
    std::vector<Handle> handles;
    const glm::dvec3 center = geometry.center();
    const auto& planes = document.effects.clip.keep;
    for (std::size_t i = 0; i < planes.size(); ++i) {
        const glm::dvec3 normal = unit(planes[i].normal);
        handles.push_back(
            {Handle::Kind::Plane, i, center - glm::dot(center - planes[i].point, normal) * normal, normal});
    }
    if (document.keep_box) add_sides(handles, Handle::Kind::KeepBox, *document.keep_box);
    if (document.remove_box) add_sides(handles, Handle::Kind::RemoveBox, *document.remove_box);
    return handles;
}

std::optional<glm::dvec2> handle_pixel(const Handle& handle, const Camera& camera, const glm::ivec2& size,
                                       double inset) {
    const auto at = project(camera, size, handle.place);
    if (!at) return std::nullopt;
    const glm::dvec2 most = glm::max(glm::dvec2(size) - inset, glm::dvec2(size) / 2.0);
    return glm::clamp(*at, glm::dvec2(size) - most, most);
}

std::optional<std::size_t> handle_at(std::span<const Handle> handles, const Camera& camera, const glm::ivec2& size,
                                     const glm::dvec2& pixel, double radius, double inset) {
    std::optional<std::size_t> nearest;
    for (std::size_t i = 0; i < handles.size(); ++i) {
        const auto at = handle_pixel(handles[i], camera, size, inset);
        if (!at) continue;
        const double distance = glm::length(*at - pixel);
        if (!(distance <= radius)) continue;
        nearest = i;
        radius = distance;
    }
    return nearest;
}

std::optional<double> along_line(const Ray& ray, const glm::dvec3& origin, const glm::dvec3& direction) {
    constexpr double kParallel = 1e-6;  // square of the sine
    const double cosine = glm::dot(ray.direction, direction), sine = 1 - cosine * cosine;
    if (!(sine >= kParallel)) return std::nullopt;
    const glm::dvec3 way = origin - ray.origin;
    const double along_ray = glm::dot(ray.direction, way), along = glm::dot(direction, way);
    const double on_line = (cosine * along_ray - along) / sine, on_ray = along_ray + cosine * on_line;
    if (!std::isfinite(on_line) || !(on_ray > 0)) return std::nullopt;
    return on_line;
}

void move_handle(SceneDocument& document, const VolumeGeometry& geometry, const Handle& handle, double millimetres) {
    if (!std::isfinite(millimetres)) return;
    if (handle.kind == Handle::Kind::Plane) {
        double low = std::numeric_limits<double>::infinity(), high = -low;
        for (const glm::dvec3& corner : corners(geometry)) {
            const double t = glm::dot(corner - handle.place, handle.normal);
            low = std::min(low, t);
            high = std::max(high, t);
        }
        document.effects.clip.keep.at(handle.index).point =
            handle.place + std::clamp(millimetres, low, high) * handle.normal;
        return;
    }
    auto& box = handle.kind == Handle::Kind::KeepBox ? document.keep_box : document.remove_box;
    if (box) move_side(*box, geometry, handle, millimetres);
}

ClipBox volume_box(const VolumeGeometry& geometry) {
    const auto all = corners(geometry);
    ClipBox box{all[0], all[0]};
    for (const glm::dvec3& corner : all) {
        box.low = glm::min(box.low, corner);
        box.high = glm::max(box.high, corner);
    }
    return box;
}

glm::dvec2 disc_of(const glm::dvec3& direction) {
    const glm::dvec3 d = unit(direction);
    const glm::dvec2 side(d);
    const double length = glm::length(side);
    if (!(length > 0)) return {d.z < 0 ? 1 : 0, 0};
    return std::atan2(length, d.z) / std::numbers::pi / length * side;
}

glm::dvec3 direction_of(const glm::dvec2& disc) {
    const double radius = glm::length(disc);
    if (!(radius > 0)) return {0, 0, 1};
    const double angle = std::numbers::pi * std::min(radius, 1.0);
    return {std::sin(angle) / radius * disc, std::cos(angle)};
}

}  // namespace edgesplat::viewer
