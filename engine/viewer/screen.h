// Between pixels and the world. Pixels are counted from the top left corner of the picture, the first one's centre is
// (0.5, 0.5).
#pragma once

#include <glm/glm.hpp>
#include <optional>

#include "engine/scene/camera.h"

namespace edgesplat::viewer {

/// World space, mm.
struct Ray {
    glm::dvec3 origin{0};
    glm::dvec3 direction{0, 1, 0};  ///< unit
    glm::dvec3 at(double millimetres) const { return origin + millimetres * direction; }
};

/// From the eye through a point of a picture of `size` pixels; the point may lie outside of it. Throws Error for a
/// camera that has no frame (camera_frame) or a picture without pixels.
Ray pixel_ray(const Camera& camera, const glm::ivec2& size, const glm::dvec2& pixel);

/// Where a world point appears, also outside the picture; none at the eye's depth or behind it. Throws like pixel_ray.
std::optional<glm::dvec2> project(const Camera& camera, const glm::ivec2& size, const glm::dvec3& world);

/// Side of a pixel, mm, at a depth along the view axis.
double pixel_size(const Camera& camera, const glm::ivec2& size, double depth);

}  // namespace edgesplat::viewer
