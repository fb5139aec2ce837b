// Cameras and parameters that change with time: smooth curves through keys, and paths that need no keys.
#pragma once

#include <glm/glm.hpp>
#include <string>
#include <vector>

#include "engine/scene/camera.h"

namespace edgesplat {

/// Where the eye is at one time, and what it looks at.
struct CameraKey {
    double time = 0;         ///< s
    glm::dvec3 eye{0};       ///< world mm
    glm::dvec3 target{0};    ///< world mm, other than the eye
    glm::dvec3 up{0, 0, 1};  ///< world, any length > 0
    double fov = 45;         ///< full vertical angle in degrees, (0, 180)
    bool operator==(const CameraKey&) const = default;
};

/// At least one key, times ascending. Before the first and after the last key the camera stands still; with `loop` the
/// last key repeats the first one's camera, and the path goes on from there as it began.
struct CameraPath {
    std::vector<CameraKey> keys;
    bool loop = false;
    bool operator==(const CameraPath&) const = default;
};

/// Checks counts, order and ranges. Throws Error naming the key, the field, the value and what was expected.
void validate(const CameraPath& path);

/// Seconds from the first key to the last.
double duration(const CameraPath& path);

/// The camera at a time in seconds: exactly the key's at a key, continuous in place, view, up and their rates between.
/// Eye, target and angle follow cubic Hermite curves whose rates at the keys keep them from overshooting (equal keys
/// stand still; collinear ones are passed monotonically, Fritsch and Carlson 1980). One `up` for all keys stays as it
/// is unless the view comes within 10 degrees of it; else it is carried along the view without rolling (Bishop 1975)
/// and the roll from key to key spread evenly, so that it never flips. Where an eye would run through its target the
/// view turns round instead. The curve turns with the keys. Throws Error.
Camera camera_at(const CameraPath& path, double time);

/// The camera `start` carried around an axis, at constant speed; keys every 5 degrees or less.
struct Orbit {
    Camera start;
    glm::dvec3 center{0};      ///< world mm: what the eye looks at and goes around
    glm::dvec3 axis{0, 0, 1};  ///< world, any length > 0; positive angles turn right-handed about it
    double degrees = 360;      ///< other than 0; multiples of 360 make a loop
    double seconds = 8;        ///< > 0
};
CameraPath orbit_path(const Orbit& orbit);

/// A flight along a smooth curve through points (centripetal Catmull-Rom, Yuksel et al. 2011) at constant speed.
struct FlyThrough {
    std::vector<glm::dvec3> points;  ///< world mm, at least two different ones
    double seconds = 8;              ///< > 0
    double look_ahead = 10;          ///< mm along the curve (beyond its end: straight on) to what the eye looks at, > 0
    glm::dvec3 up{0, 0, 1};          ///< world, any length > 0
    double fov = 60;                 ///< degrees, (0, 180)
};
CameraPath fly_through(const FlyThrough& flight);

/// A number that changes with time, under the key it has in a scene file, such as "effects.fog.density".
struct AnimatedParameter {
    struct Key {
        double time = 0;  ///< s
        double value = 0;
        bool operator==(const Key&) const = default;
    };
    std::string key;
    std::vector<Key> values;  ///< at least one, times ascending
    bool operator==(const AnimatedParameter&) const = default;
};

/// Checks counts, order and finiteness. Throws Error naming the parameter, the value and what was expected.
void validate(const AnimatedParameter& parameter);

/// The value at a time: exact at the keys, monotone between them with a continuous rate, constant before and after.
double value_at(const AnimatedParameter& parameter, double time);

}  // namespace edgesplat
