// Travelling along the centre line of a cavity: played, scrubbed, looked around from.
#pragma once

#include <future>
#include <memory>
#include <optional>

#include "engine/viewer/guided_path.h"
#include "engine/viewer/walls.h"

namespace edgesplat::viewer {

class Tour {
  public:
    /// The ends, world mm; the line is looked for once both are there.
    std::optional<glm::dvec3> from, to;
    double speed = 20;   ///< mm/s
    double fov = 70;     ///< degrees
    glm::dvec2 look{0};  ///< radians that one looks to the right and up of the line's direction
    bool playing = false;

    /// Looks for the line between the ends, on a thread. Does nothing without both.
    void find(std::shared_ptr<const Walls> walls);
    bool searching() const { return search_.valid(); }
    /// Takes what was found: whether there is something new to say. `wait`: until it is.
    bool poll(bool wait);
    const std::optional<GuidedPath>& line() const { return line_; }
    /// No line connects the ends of the last search.
    bool failed() const { return failed_; }
    void clear();

    /// mm from the beginning, [0, length].
    double position() const { return position_; }
    void set_position(double millimetres);
    void step(double seconds);
    /// Plays, from the beginning where the end was reached, or stops. Does nothing without a line.
    void toggle();
    /// Throws Error without a line.
    Camera camera(const glm::dvec3& up) const;
    /// The whole way at its speed, for a movie. Throws Error without a line.
    CameraPath path(const glm::dvec3& up) const;

  private:
    std::optional<GuidedPath> line_;
    std::future<std::optional<GuidedPath>> search_;
    double position_ = 0;
    bool failed_ = false;
};

}  // namespace edgesplat::viewer
