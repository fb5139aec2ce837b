#include "engine/viewer/screen.h"

#include "engine/error.h"

namespace edgesplat::viewer {
namespace {

void check(const glm::ivec2& size) {
    if (size.x < 1 || size.y < 1) fail("picture size: {} x {}, expected at least 1 x 1 pixels", size.x, size.y);
}

}  // namespace

Ray pixel_ray(const Camera& camera, const glm::ivec2& size, const glm::dvec2& pixel) {
    check(size);
    const CameraFrame frame = camera_frame(camera);
    const double unit = 2 * frame.tan_half_y / size.y;
    const glm::dvec2 side = (pixel - glm::dvec2(size) / 2.0) * unit;
    return {frame.eye, glm::normalize(frame.forward + side.x * frame.right - side.y * frame.up)};
}

std::optional<glm::dvec2> project(const Camera& camera, const glm::ivec2& size, const glm::dvec3& world) {
    check(size);
    const CameraFrame frame = camera_frame(camera);
    const glm::dvec3 from_eye = world - frame.eye;
    const double depth = glm::dot(from_eye, frame.forward);
    if (!(depth > 0)) return std::nullopt;
    const double scale = size.y / (2 * frame.tan_half_y * depth);
    return glm::dvec2(size) / 2.0 + scale * glm::dvec2(glm::dot(from_eye, frame.right), -glm::dot(from_eye, frame.up));
}

double pixel_size(const Camera& camera, const glm::ivec2& size, double depth) {
    check(size);
    return 2 * camera_frame(camera).tan_half_y * depth / size.y;
}

}  // namespace edgesplat::viewer
