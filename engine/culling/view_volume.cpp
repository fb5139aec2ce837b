#include "engine/culling/view_volume.h"

#include <algorithm>
#include <cmath>

#include "footprints/kernel.h"

namespace edgesplat {
namespace {

/// A plane's value at a widened box's middle, and the largest difference to it at a corner.
glm::dvec2 over_box(const glm::dvec4& plane, const glm::ivec3& low, const glm::ivec3& size, double reach) {
    const glm::dvec3 half = 0.5 * glm::dvec3(size - 1) + reach;
    const glm::dvec3 middle = glm::dvec3(low) + 0.5 * glm::dvec3(size - 1);
    return {glm::dot(plane, {middle, 1}), glm::dot(glm::abs(glm::dvec3(plane)), half)};
}

}  // namespace

ViewVolume::ViewVolume(const VolumeGeometry& geometry, const Camera& camera, const glm::ivec2& size, bool antialias) {
    const CameraFrame view = camera_frame(camera);
    const double tan_half_x = view.tan_half_y * size.x / size.y;
    // The pixel's kernel has the radius kKernelRadius in pixels; rays cross the picture's sides obliquely.
    const double slope = std::max(tan_half_x, view.tan_half_y);
    const double pixels = 1 + (antialias ? kKernelRadius * std::sqrt(1 + slope * slope) : 0);
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

}  // namespace edgesplat
