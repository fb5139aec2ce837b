#include "engine/scene/camera.h"

#include <algorithm>
#include <cmath>

#include "engine/error.h"

namespace edgesplat {

namespace {

bool finite(const glm::dvec3& v) {
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

/// Unit vector of v; scaled first to avoid overflow and underflow of the square.
glm::dvec3 direction_of(const glm::dvec3& v) {
    const double largest = std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)});
    return glm::normalize(v / largest);
}

}  // namespace

CameraFrame camera_frame(const Camera& camera) {
    const auto refuse = [](const char* field, const glm::dvec3& v, const char* expected) {
        fail("camera {}: ({}, {}, {}) is not {}", field, v.x, v.y, v.z, expected);
    };
    if (!finite(camera.eye)) refuse("eye", camera.eye, "finite");
    if (!finite(camera.direction) || camera.direction == glm::dvec3(0)) {
        refuse("direction", camera.direction, "a finite vector other than 0");
    }
    if (!finite(camera.up)) refuse("up", camera.up, "finite");
    if (!(camera.fov_y > 0 && camera.fov_y < 180)) {
        fail("camera fov_y: {} is not between 0 and 180 degrees (both excluded)", camera.fov_y);
    }

    CameraFrame frame;
    frame.eye = camera.eye;
    frame.forward = direction_of(camera.direction);
    glm::dvec3 right(0);
    if (camera.up != glm::dvec3(0)) right = glm::cross(frame.forward, direction_of(camera.up));
    if (!(glm::length(right) > 1e-6)) {
        int axis = 0;
        for (int i = 1; i < 3; ++i) {
            if (std::abs(frame.forward[i]) < std::abs(frame.forward[axis])) axis = i;
        }
        glm::dvec3 other(0);
        other[axis] = 1;
        right = glm::cross(frame.forward, other);
    }
    frame.right = glm::normalize(right);
    frame.up = glm::cross(frame.right, frame.forward);
    frame.tan_half_y = std::tan(glm::radians(camera.fov_y) / 2);
    return frame;
}

}  // namespace edgesplat
