// A tour along the centre line of a cavity: playing, seeking, looking around.
#pragma once

#include <future>
#include <memory>
#include <optional>

#include "engine/viewer/guided_path.h"
#include "engine/viewer/walls.h"

namespace edgesplat::viewer {

class Tour {
  public:
    /// The ends, world mm; `find` needs both.
    std::optional<glm::dvec3> from, to;
    double speed = 20;   ///< mm/s
    double fov = 70;     ///< degrees
    glm::dvec2 look{0};  ///< radians that the view turns to the right and up from the line's direction
    bool playing = false;

    /// Searches the line between the ends, on a thread. Does nothing without both.
    void find(std::shared_ptr<const Walls> walls);
    bool searching() const { return search_.valid(); }
    /// Takes the result of a search. Returns whether there is a new one. `wait`: waits for it.
    bool poll(bool wait);
    const std::optional<GuidedPath>& line() const { return line_; }
    /// Whether the last search found no line.
    bool failed() const { return failed_; }
    void clear();

    /// mm from the beginning, in [0, length].
    double position() const { return position_; }
    void set_position(double millimetres);
    void step(double seconds);
    /// Starts playing (from the beginning if the end was reached) or stops. Does nothing without a line.
    void toggle();
    /// Throws Error without a line.
    Camera camera(const glm::dvec3& up) const;
    /// The camera path of the whole line at `speed`, for a movie. Throws Error without a line.
    CameraPath path(const glm::dvec3& up) const;

  private:
    std::optional<GuidedPath> line_;
    std::future<std::optional<GuidedPath>> search_;
    double position_ = 0;
    bool failed_ = false;
};

}  // namespace edgesplat::viewer
