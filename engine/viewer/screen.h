// Converts between pixels and world space. Pixels are counted from the picture's top left corner; the centre of the
// first one is (0.5, 0.5).
#pragma once

#include <glm/glm.hpp>
#include <optional>

#include "engine/scene/camera.h"

namespace edgesplat::viewer {

/// A ray in world space, mm.
struct Ray {
    glm::dvec3 origin{0};
    glm::dvec3 direction{0, 1, 0};  ///< unit
    glm::dvec3 at(double millimetres) const { return origin + millimetres * direction; }
};

/// The ray from the eye through a point of a picture of `size` pixels; the point may lie outside the picture. Throws
/// Error for a camera without a frame (camera_frame) and a picture without pixels.
Ray pixel_ray(const Camera& camera, const glm::ivec2& size, const glm::dvec2& pixel);

/// The pixel of a world point, also outside the picture; nullopt at the eye's depth or behind it. Throws like
/// pixel_ray.
std::optional<glm::dvec2> project(const Camera& camera, const glm::ivec2& size, const glm::dvec3& world);

/// Side of a pixel, mm, at a depth (mm) along the view axis.
double pixel_size(const Camera& camera, const glm::ivec2& size, double depth);

}  // namespace edgesplat::viewer
