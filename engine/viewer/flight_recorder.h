// Records a flight as camera keys.
#pragma once

#include "engine/scene/camera_path.h"

namespace edgesplat::viewer {

/// Cameras with their times. `path` leaves out those that the curve through their neighbours reproduces.
class FlightRecorder {
  public:
    void start();
    /// Records the camera, `seconds` after the previous call. Does nothing unless recording.
    void step(const Camera& camera, double seconds);
    void stop() { recording_ = false; }
    bool recording() const { return recording_; }
    double seconds() const { return time_; }
    bool empty() const { return keys_.size() < 2; }

    /// The flight with few keys: the eye stays within `tolerance` mm and the view within half a degree of the
    /// recording. Throws Error if nothing was recorded.
    CameraPath path(double tolerance) const;

  private:
    bool recording_ = false;
    double time_ = 0;
    std::vector<CameraKey> keys_;  ///< one per step; targets 100 mm ahead of the eye
};

}  // namespace edgesplat::viewer
