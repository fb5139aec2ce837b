#include "engine/viewer/flight_recorder.h"

#include <algorithm>
#include <cmath>

#include "engine/error.h"

namespace edgesplat::viewer {
namespace {

constexpr double kMostDegrees = 0.5;
constexpr double kTargetReach = 100;  // mm from the eye to a key's target

/// Whether the curve through `keys` follows the recorded steps between `first` and `last`.
bool follows(const std::vector<CameraKey>& keys, const std::vector<CameraKey>& steps, std::size_t first,
             std::size_t last, double tolerance) {
    const CameraPath path{keys, false};
    for (std::size_t i = first + 1; i < last; ++i) {
        const Camera at = camera_at(path, steps[i].time);
        const glm::dvec3 flown = glm::normalize(steps[i].target - steps[i].eye), drawn = glm::normalize(at.direction);
        const double angle = glm::degrees(std::atan2(glm::length(glm::cross(flown, drawn)), glm::dot(flown, drawn)));
        if (glm::length(at.eye - steps[i].eye) > tolerance || angle > kMostDegrees) return false;
    }
    return true;
}

}  // namespace

void FlightRecorder::start() {
    recording_ = true;
    time_ = 0;
    keys_.clear();
}

void FlightRecorder::step(const Camera& camera, double seconds) {
    if (!recording_) return;
    if (!keys_.empty()) time_ += seconds;
    if (!keys_.empty() && !(seconds > 0)) return;
    keys_.push_back(
        {time_, camera.eye, camera.eye + kTargetReach * glm::normalize(camera.direction), camera.up, camera.fov_y});
}

CameraPath FlightRecorder::path(double tolerance) const {
    if (empty()) fail("recording: no flight was recorded; expected at least two cameras");
    std::vector<CameraKey> kept{keys_.front()};
    std::size_t from = 0;
    while (from + 1 < keys_.size()) {
        // The longest piece that two keys reproduce: double its length until that fails, then halve the step.
        std::size_t good = from + 1, step = 1;
        const auto holds = [&](std::size_t to) {
            const std::vector<CameraKey> ends{keys_[from], keys_[to]};
            return follows(ends, keys_, from, to, tolerance);
        };
        while (good + step < keys_.size() && holds(good + step)) {
            good += step;
            step *= 2;
        }
        for (; step > 0; step /= 2)
            if (good + step < keys_.size() && holds(good + step)) good += step;
        kept.push_back(keys_[good]);
        from = good;
    }
    CameraPath path{std::move(kept), false};
    validate(path);
    return path;
}

}  // namespace edgesplat::viewer
