// A perspective camera in world space (mm).
#pragma once

#include <glm/glm.hpp>

namespace edgesplat {

/// Right-handed: `right` is screen +x, `up` is screen +y (towards the top row), `direction` points into the picture.
struct Camera {
    glm::dvec3 eye{0};              ///< mm
    glm::dvec3 direction{0, 1, 0};  ///< any length > 0
    glm::dvec3 up{0, 0, 1};         ///< any length > 0; is orthogonalised to direction
    double fov_y = 45;              ///< full vertical angle in degrees, (0, 180)
};

/// Orthonormal frame of a camera. An `up` parallel to the view is replaced by the world axis least parallel to it.
/// Throws Error for a zero direction, or a field of view outside (0, 180).
struct CameraFrame {
    glm::dvec3 eye, right, up, forward;
    double tan_half_y = 0;  ///< tan(fov_y / 2)
};
CameraFrame camera_frame(const Camera& camera);

}  // namespace edgesplat
