#include "engine/frame_view_volume.h"

#include <algorithm>
#include <cmath>

namespace edgesplat {
namespace {

/// The values of a plane at a box's middle, and how far from it those of its corners go.
glm::dvec2 over_box(const glm::dvec4& plane, const glm::ivec3& low, const glm::ivec3& size, double reach) {
    const glm::dvec3 half = 0.5 * glm::dvec3(size - 1) + reach;
    const glm::dvec3 middle = glm::dvec3(low) + 0.5 * glm::dvec3(size - 1);
    return {glm::dot(plane, {middle, 1}), glm::dot(glm::abs(glm::dvec3(plane)), half)};
}

}  // namespace

ViewVolume::ViewVolume(const VolumeGeometry& geometry, const Camera& camera, const glm::ivec2& size, double pixels) {
    const CameraFrame view = camera_frame(camera);
    const double tan_half_x = view.tan_half_y * size.x / size.y;
    const double wide = 1.001 + 2.0 * pixels / std::min(size.x, size.y);
    const glm::dvec3 inward[5] = {
        view.forward * tan_half_x * wide - view.right, view.forward * tan_half_x * wide + view.right,
        view.forward * view.tan_half_y * wide - view.up, view.forward * view.tan_half_y * wide + view.up, view.forward};
    for (int i = 0; i < 5; ++i) {
        const glm::dvec3 normal = glm::transpose(geometry.index_to_world_axes) * inward[i];
        planes_[i] = glm::dvec4(normal, glm::dot(inward[i], geometry.origin - view.eye));
    }
}

bool ViewVolume::shows(const glm::ivec3& low, const glm::ivec3& size, double reach) const {
    return std::ranges::all_of(planes_, [&](const glm::dvec4& plane) {
        const glm::dvec2 values = over_box(plane, low, size, reach);
        return values.x + values.y >= 0;
    });
}

bool ViewVolume::holds(const glm::ivec3& low, const glm::ivec3& size, double reach) const {
    return std::ranges::all_of(planes_, [&](const glm::dvec4& plane) {
        const glm::dvec2 values = over_box(plane, low, size, reach);
        return values.x - values.y >= 0;
    });
}

double pixels_of_filter(const Camera& camera, const glm::ivec2& size, double support) {
    const double tan_half_y = camera_frame(camera).tan_half_y;
    const double widest = tan_half_y * std::max(1.0, static_cast<double>(size.x) / size.y);
    // A plane through the eye of that slope is passed obliquely.
    return 1 + support * std::sqrt(1 + widest * widest);
}

}  // namespace edgesplat
