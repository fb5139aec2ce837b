// Moves the camera: around an object or through it, smoothly at any frame rate.
#pragma once

#include <glm/glm.hpp>
#include <memory>
#include <optional>

#include "engine/scene/camera.h"
#include "engine/viewer/walls.h"

namespace edgesplat::viewer {

/// User input: held, or given since the last step. Values that are not finite count as 0 (boost: 1); absurd values are
/// clamped.
struct Controls {
    glm::dvec3 move{0};   ///< right, up, forward, -1..1 each
    glm::dvec2 look{0};   ///< radians by which the view turns: right, up
    double roll = 0;      ///< -1..1; > 0 turns the head clockwise (the picture counter-clockwise)
    glm::dvec2 orbit{0};  ///< radians by which the eye orbits the centre: right, up
    glm::dvec2 pan{0};    ///< translation of eye and centre: right, up, fractions of the picture's height at the centre
    double zoom = 0;      ///< steps of the wheel, > 0 nearer; each multiplies the distance by 0.85
    double boost = 1;     ///< factor on speed
};

enum class MotionMode { Orbit, Fly };

/// A camera that controls move. Velocities follow the controls with a time constant of about 0.1 s, in closed form. One
/// long step and many short ones therefore end in the same place, unless the direction turns on the way.
///
/// Orbit uses orbit, pan, zoom, roll and move (of eye and centre together); there are no collisions. The eye orbits
/// around the axis `up` of the home camera (which `roll` turns) and stops above the poles. A camera with another roll
/// is levelled gradually as it orbits. The centre keeps its place in the picture.
///
/// Fly uses move, look and roll, all in the camera's frame. With collisions, the eye slides along walls. It keeps 0.75
/// voxel from them where there is room, and always 0.4. An eye that is placed with less room, or inside matter, moves
/// freely until it has that room.
class Motion {
  public:
    static constexpr double kClearance = 0.75, kLeastClearance = 0.4;  ///< Walls::voxel()

    /// Looks along +y from the origin, mode Orbit, collisions on.
    Motion();

    /// Sets the target of home(); does not move the camera. Throws Error for a camera without a frame.
    void set_home(const Camera& home, const glm::dvec3& center);
    /// Null: no walls.
    void set_walls(std::shared_ptr<const Walls> walls);
    /// From Fly to Orbit, the centre becomes the point straight ahead: at the wall, or at the previous distance.
    void set_mode(MotionMode mode);
    MotionMode mode() const { return mode_; }
    void set_collisions(bool on);
    bool collisions() const { return collisions_; }
    /// Sets the camera's field of view at once; between 1 and 170 degrees, else ignored.
    void set_fov(double degrees);

    /// Moves to a camera at once and stops all motion. Throws Error for a camera without a frame.
    void jump(const Camera& camera);
    /// Moves smoothly to a camera, through walls, and ends exactly there. Any control but boost interrupts it. Throws
    /// Error for a camera without a frame; `seconds` <= 0 jumps.
    void fly_to(const Camera& camera, const glm::dvec3& center, double seconds);
    /// Moves smoothly to the home camera; without set_home, to the first camera.
    void home();
    void set_center(const glm::dvec3& center);

    /// 0 < seconds; long steps are divided, more than 10 s count as 10 s.
    void step(const Controls& controls, double seconds);

    const Camera& camera() const { return camera_; }
    const glm::dvec3& center() const { return center_; }
    /// Flying speed at this place for a full `move`, mm/s: twice the distance to the nearest wall per second, within
    /// bounds that depend on voxel and volume size.
    double speed() const;
    /// Whether the next step without controls would still change the camera.
    bool moving() const;
    /// Whether fly_to or home is still moving the camera.
    bool travelling() const { return flight_.has_value(); }

  private:
    struct Flight {
        Camera from, to;
        glm::dvec3 from_center, to_center;
        double seconds = 1, elapsed = 0;
    };
    /// Motion still to come from past controls.
    struct Momentum {
        glm::dvec3 velocity{0};  ///< mm/s, world
        double roll_rate = 0;    ///< radians/s
        glm::dvec2 look{0}, orbit{0}, pan{0};
        double zoom = 0;
    };

    void travel(double seconds);
    void glide(const Controls& rates, double seconds);
    void orbit_about_center(const glm::dvec2& angles);
    void turn(const glm::dvec2& angles, double roll);
    void shift(const glm::dvec3& way);
    glm::dvec3 collided(const glm::dvec3& way);
    void settle();
    double extent() const;

    Camera camera_, home_;
    glm::dvec3 center_{0, 1, 0}, home_center_{0, 1, 0};
    glm::dvec3 axis_{0, 0, 1};  ///< unit: the axis of orbits
    std::shared_ptr<const Walls> walls_;
    MotionMode mode_ = MotionMode::Orbit;
    bool collisions_ = true;
    bool has_home_ = false;
    bool entered_ = false;  ///< the eye has had room since it was placed, so walls stop it
    Momentum momentum_;
    std::optional<Flight> flight_;
};

}  // namespace edgesplat::viewer
