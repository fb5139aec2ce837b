// How the eye moves: around an object or through it, smoothly in time whatever the frame rate.
#pragma once

#include <glm/glm.hpp>
#include <memory>
#include <optional>

#include "engine/scene/camera.h"
#include "engine/viewer/walls.h"

namespace edgesplat::viewer {

/// What a person holds down, or did since the last step. What is not finite counts as 0 (boost: 1); absurd amounts are
/// cut down.
struct Controls {
    glm::dvec3 move{0};   ///< right, up, forward, -1..1 each
    glm::dvec2 look{0};   ///< radians that the view turns: right, up
    double roll = 0;      ///< -1..1; > 0 turns the head clockwise (the picture counter-clockwise)
    glm::dvec2 orbit{0};  ///< radians that the eye goes around the centre: right, up
    glm::dvec2 pan{0};    ///< that eye and centre shift: right, up, fractions of the picture's height at the centre
    double zoom = 0;      ///< steps of the wheel, > 0 nearer; each leaves 0.85 of the distance
    double boost = 1;     ///< factor on speed
};

enum class MotionMode { Orbit, Fly };

/// A camera that controls move. Velocities follow the controls with a time constant of about 0.1 s in closed form, so
/// that one long step and many short ones end in the same place but for what turns with the way.
///
/// Orbit takes orbit, pan, zoom, roll and move (of eye and centre together); nothing is solid. The eye goes around the
/// axis `up` of the home camera (which `roll` turns) and stops above the poles; a camera that was rolled otherwise is
/// levelled little by little as it orbits. The centre stays where it is in the picture.
///
/// Fly takes move, look and roll, all in the camera's own frame. With collisions on the eye keeps 0.75 voxel from walls
/// where there is that much room, always 0.4, and slides along them. Where it is put into less room than that, or into
/// matter, it moves freely until it has got out.
class Motion {
  public:
    static constexpr double kClearance = 0.75, kLeastClearance = 0.4;  ///< Walls::voxel()

    /// Looks along +y from the origin, mode Orbit, collisions on.
    Motion();

    /// Where home() goes; does not move the camera. Throws Error for a camera without a frame.
    void set_home(const Camera& home, const glm::dvec3& center);
    /// Null: nothing is solid.
    void set_walls(std::shared_ptr<const Walls> walls);
    /// From Fly to Orbit the centre becomes what is straight ahead (the wall, or as far away as it was).
    void set_mode(MotionMode mode);
    MotionMode mode() const { return mode_; }
    void set_collisions(bool on);
    bool collisions() const { return collisions_; }
    /// Of the camera, at once; between 1 and 170 degrees, else ignored.
    void set_fov(double degrees);

    /// At once, and at rest. Throws Error for a camera without a frame.
    void jump(const Camera& camera);
    /// Eased, through walls; at the end exactly `camera`. Any control but boost interrupts it. Throws Error for a
    /// camera without a frame; `seconds` <= 0 jumps.
    void fly_to(const Camera& camera, const glm::dvec3& center, double seconds);
    /// Eased; without set_home, to where the first camera was.
    void home();
    void set_center(const glm::dvec3& center);

    /// 0 < seconds; long steps are divided, more than 10 s count as 10 s.
    void step(const Controls& controls, double seconds);

    const Camera& camera() const { return camera_; }
    const glm::dvec3& center() const { return center_; }
    /// mm/s that a full `move` gives here and now: twice the distance to the nearest wall a second, within bounds that
    /// follow from voxels and volume.
    double speed() const;
    /// Whether the next step without controls would still change the camera.
    bool moving() const;
    /// Whether fly_to or home is on its way.
    bool travelling() const { return flight_.has_value(); }

  private:
    struct Flight {
        Camera from, to;
        glm::dvec3 from_center, to_center;
        double seconds = 1, elapsed = 0;
    };
    /// What is still to come of controls that were given.
    struct Momentum {
        glm::dvec3 velocity{0};  ///< mm/s, world
        double roll_rate = 0;    ///< radians/s
        glm::dvec2 look{0}, orbit{0}, pan{0};
        double zoom = 0;
    };

    void travel(double seconds);
    void glide(const Controls& rates, double seconds);
    void go_round(const glm::dvec2& angles);
    void turn(const glm::dvec2& angles, double roll);
    void shift(const glm::dvec3& way);
    glm::dvec3 collided(const glm::dvec3& way);
    void settle();
    double extent() const;

    Camera camera_, home_;
    glm::dvec3 center_{0, 1, 0}, home_center_{0, 1, 0};
    glm::dvec3 axis_{0, 0, 1};  ///< unit: what orbiting goes around
    std::shared_ptr<const Walls> walls_;
    MotionMode mode_ = MotionMode::Orbit;
    bool collisions_ = true;
    bool has_home_ = false;
    bool entered_ = false;  ///< since it was put where it is the eye has had room, and walls hold it back
    Momentum momentum_;
    std::optional<Flight> flight_;
};

}  // namespace edgesplat::viewer
