#include "engine/viewer/tour.h"

#include <algorithm>
#include <chrono>
#include <cmath>

#include "engine/error.h"

namespace edgesplat::viewer {

void Tour::find(std::shared_ptr<const Walls> walls) {
    if (!from || !to || !walls) return;
    playing = false;
    failed_ = false;
    search_ = std::async(std::launch::async,
                         [walls = std::move(walls), a = *from, b = *to] { return guided_path(*walls, a, b); });
}

bool Tour::poll(bool wait) {
    if (!search_.valid()) return false;
    if (!wait && search_.wait_for(std::chrono::seconds(0)) != std::future_status::ready) return false;
    line_ = search_.get();
    failed_ = !line_;
    position_ = 0;
    look = glm::dvec2(0);
    return true;
}

void Tour::clear() {
    from.reset();
    to.reset();
    line_.reset();
    playing = failed_ = false;
    position_ = 0;
}

void Tour::set_position(double millimetres) {
    position_ = line_ ? std::clamp(millimetres, 0.0, line_->length) : 0;
}

void Tour::toggle() {
    if (!line_) return;
    if (!playing && position_ >= line_->length) set_position(0);
    playing = !playing;
}

void Tour::step(double seconds) {
    if (!playing || !line_) return;
    set_position(position_ + speed * seconds);
    if (position_ >= line_->length) playing = false;
}

Camera Tour::camera(const glm::dvec3& up) const {
    if (!line_) fail("guided path: none has been found yet");
    Camera camera = camera_along(*line_, position_, fov, up);
    const CameraFrame frame = camera_frame(camera);
    const glm::dvec3 turned = std::cos(look.x) * frame.forward + std::sin(look.x) * frame.right;
    camera.direction = std::cos(look.y) * turned + std::sin(look.y) * frame.up;
    camera.up = std::cos(look.y) * frame.up - std::sin(look.y) * turned;
    return camera;
}

CameraPath Tour::path(const glm::dvec3& up) const {
    if (!line_) fail("guided path: none has been found yet");
    return camera_path_along(*line_, line_->length / speed, fov, up);
}

}  // namespace edgesplat::viewer
