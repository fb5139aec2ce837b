// Time-dependent cameras and parameters: smooth curves through keys, orbits and flights.
#pragma once

#include <glm/glm.hpp>
#include <string>
#include <vector>

#include "engine/scene/camera.h"

namespace edgesplat {

/// The camera at one time.
struct CameraKey {
    double time = 0;         ///< s
    glm::dvec3 eye{0};       ///< world mm
    glm::dvec3 target{0};    ///< world mm, other than the eye
    glm::dvec3 up{0, 0, 1};  ///< world, any length > 0
    double fov = 45;         ///< full vertical angle in degrees, (0, 180)
    bool operator==(const CameraKey&) const = default;
};

/// At least one key, times ascending. The camera stands still before the first and after the last key. With `loop` the
/// last key repeats the first one's camera, and the path is periodic.
struct CameraPath {
    std::vector<CameraKey> keys;
    bool loop = false;
    bool operator==(const CameraPath&) const = default;
};

/// Checks counts, order and ranges. Throws Error naming the key, the field, the value and what was expected.
void validate(const CameraPath& path);

/// Seconds from the first key to the last.
double duration(const CameraPath& path);

/// The camera at a time in seconds. At a key it is exactly the key's camera; between keys, position, view, up and their
/// rates are continuous. Eye, target and angle follow cubic Hermite curves without overshoot: equal keys stand still,
/// collinear keys are passed monotonically (Fritsch and Carlson 1980). If all keys have the same `up`, it is used
/// unchanged, unless the view comes within 10 degrees of it. Otherwise `up` is transported along the view without roll
/// (Bishop 1975), and the roll between keys is distributed evenly, so that it never flips. Where the eye would pass
/// through its target, the view is rotated instead. The curve is equivariant under rotation of the keys. Throws Error.
Camera camera_at(const CameraPath& path, double time);

/// A rotation of the camera `start` around an axis at constant speed; keys every 5 degrees or less.
struct Orbit {
    Camera start;
    glm::dvec3 center{0};      ///< world mm: target of the eye and centre of the orbit
    glm::dvec3 axis{0, 0, 1};  ///< world, any length > 0; positive angles are right-handed
    double degrees = 360;      ///< not 0; multiples of 360 make a loop
    double seconds = 8;        ///< > 0
};
CameraPath orbit_path(const Orbit& orbit);

/// A flight along a smooth curve through points (centripetal Catmull-Rom, Yuksel et al. 2011) at constant speed.
struct FlyThrough {
    std::vector<glm::dvec3> points;  ///< world mm, at least two different ones
    double seconds = 8;              ///< > 0
    /// Distance of the target ahead on the curve, mm, > 0; beyond its end the curve continues straight.
    double look_ahead = 10;
    glm::dvec3 up{0, 0, 1};  ///< world, any length > 0
    double fov = 60;         ///< degrees, (0, 180)
};
CameraPath fly_through(const FlyThrough& flight);

/// A time-dependent number. `key` is its key in a scene file, such as "effects.fog.density".
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
