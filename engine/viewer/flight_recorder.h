// A flight as it was flown, kept as camera keys.
#pragma once

#include "engine/scene/camera_path.h"

namespace edgesplat::viewer {

/// Cameras with their times. Those that the curve through their neighbours gives anyway are left out.
class FlightRecorder {
  public:
    void start();
    /// The camera `seconds` after the last call. Does nothing unless recording.
    void step(const Camera& camera, double seconds);
    void stop() { recording_ = false; }
    bool recording() const { return recording_; }
    double seconds() const { return time_; }
    bool empty() const { return keys_.size() < 2; }

    /// The flight with as few keys as keep the eye within `tolerance` mm and the view within half a degree of what was
    /// flown. Throws Error where nothing was recorded.
    CameraPath path(double tolerance) const;

  private:
    bool recording_ = false;
    double time_ = 0;
    std::vector<CameraKey> keys_;  ///< every step; targets 1 mm ahead of the eye
};

}  // namespace edgesplat::viewer
