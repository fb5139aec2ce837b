#include "engine/scene/camera_path.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "engine/error.h"
#include "engine/scene/hermite.h"

namespace edgesplat {
namespace {

constexpr int kUpSteps = 16;          ///< steps of the transport of the up direction between two keys
constexpr double kRunsThrough = 0.1;  ///< share of the keys' distances to their targets: below it, the view is rotated
constexpr double kAlongUp = 0.985;    ///< cosine (10 degrees) above which a view counts as parallel to `up`

/// Applies to v the shortest rotation from one unit vector to another. Not for opposite vectors.
glm::dvec3 turned(const glm::dvec3& v, const glm::dvec3& from, const glm::dvec3& to) {
    const glm::dvec3 axis = glm::cross(from, to);
    const double cosine = glm::dot(from, to);
    return v * cosine + glm::cross(axis, v) + axis * (glm::dot(axis, v) / (1 + cosine));
}

/// v rotated right-handed by an angle about a unit axis (Rodrigues).
glm::dvec3 turned_about(const glm::dvec3& v, double angle, const glm::dvec3& axis) {
    const double cosine = std::cos(angle), sine = std::sin(angle);
    return v * cosine + glm::cross(axis, v) * sine + axis * (glm::dot(axis, v) * (1 - cosine));
}

/// v rotated about an axis whose length is the angle.
glm::dvec3 turned_about(const glm::dvec3& v, const glm::dvec3& rotation) {
    const double angle = glm::length(rotation);
    return angle > 0 ? turned_about(v, angle, rotation / angle) : v;
}

/// Angle from a to b about a unit vector perpendicular to both, (-pi, pi].
double angle_about(const glm::dvec3& axis, const glm::dvec3& a, const glm::dvec3& b) {
    return std::atan2(glm::dot(axis, glm::cross(a, b)), glm::dot(a, b));
}

Camera camera_of(const CameraKey& key) {
    return {key.eye, key.target - key.eye, key.up, key.fov};
}

/// The interpolating curves of a path.
class Curves {
  public:
    explicit Curves(const CameraPath& path) : loop_(path.loop) {
        for (const CameraKey& key : path.keys) {
            for (auto* keys : {&eye_, &target_}) {
                keys->times.push_back(key.time);
                keys->closed = path.loop;
            }
            eye_.values.push_back(key.eye);
            target_.values.push_back(key.target);
            fov_.values.push_back(key.fov);
            up_.push_back(camera_frame(camera_of(key)).up);
        }
        fov_.times = eye_.times;
        fov_.closed = path.loop;
        keep_upright(path);
    }

    Camera at(std::size_t i, double u) const {
        const Span span = span_at(i);
        Camera camera;
        camera.eye = hermite::value(eye_, i, u);
        camera.direction = look(span, u);
        camera.up = upright_ ? *upright_ : up(span, i, u);
        camera.fov_y = hermite::value(fov_, i, u);
        return camera;
    }

  private:
    /// If all keys have the same up and the view never comes near it, uses it unchanged.
    void keep_upright(const CameraPath& path) {
        const glm::dvec3 up = glm::normalize(path.keys.front().up);
        for (const CameraKey& key : path.keys)
            if (key.up != path.keys.front().up) return;
        for (std::size_t i = 0; i + 1 < path.keys.size(); ++i) {
            const Span span = span_at(i);
            for (int k = 0; k <= kUpSteps; ++k)
                if (!(std::abs(glm::dot(glm::normalize(look(span, double(k) / kUpSteps)), up)) < kAlongUp)) return;
        }
        upright_ = up;
    }

    /// The section between two keys.
    struct Span {
        std::size_t first = 0;
        bool turns_round = false;                  ///< the eye would pass through its target, so the view is rotated
        glm::dvec3 turn{0};                        ///< axis times angle from the first view to the second
        glm::dvec3 first_rate{0}, second_rate{0};  ///< rates of the view: axis times radians per span
    };

    glm::dvec3 look_at_key(std::size_t i) const { return target_.values[i] - eye_.values[i]; }
    double seconds(std::size_t i) const { return eye_.times[i + 1] - eye_.times[i]; }
    glm::dvec3 direct_look(std::size_t i, double u) const {
        return hermite::value(target_, i, u) - hermite::value(eye_, i, u);
    }

    Span span_at(std::size_t i) const {
        const glm::dvec3 from = look_at_key(i), to = look_at_key(i + 1);
        const double least = kRunsThrough * std::min(glm::length(from), glm::length(to));
        Span span;
        span.first = i;
        for (int k = 1; k < 2 * kUpSteps; ++k)
            span.turns_round |= !(glm::length(direct_look(i, k / (2.0 * kUpSteps))) > least);
        if (!span.turns_round) return span;
        const auto rate = [&](std::size_t key, const glm::dvec3& view) {
            const glm::dvec3 change = hermite::rate(target_, key) - hermite::rate(eye_, key);
            return glm::cross(view, change) / glm::dot(view, view) * seconds(i);
        };
        span.first_rate = rate(i, from);
        span.second_rate = rate(i + 1, to);
        const glm::dvec3 a = glm::normalize(from), b = glm::normalize(to);
        const glm::dvec3 across = glm::cross(a, b);
        const double sine = glm::length(across);
        span.turn = (sine > 1e-6 ? across / sine : up_[i]) * std::atan2(sine, glm::dot(a, b));
        return span;
    }

    /// View vector from the eye towards the target; mm if the target is followed.
    glm::dvec3 look(const Span& span, double u) const {
        if (!span.turns_round) return direct_look(span.first, u);
        const hermite::Weights w(u);
        glm::dvec3 view = turned_about(glm::normalize(look_at_key(span.first)), span.turn * w.second);
        view = turned_about(view, span.first_rate * w.first_rate);
        return turned_about(view, span.second_rate * w.second_rate);
    }

    /// The first key's up, transported along the view to u without roll.
    glm::dvec3 carried_up(const Span& span, double u) const {
        const int steps = std::min(static_cast<int>(u * kUpSteps), kUpSteps - 1);
        glm::dvec3 view = glm::normalize(look(span, 0)), up = up_[span.first];
        const auto carry = [&](double to) {
            const glm::dvec3 next = glm::normalize(look(span, to));
            up = turned(up, view, next);
            view = next;
        };
        for (int k = 1; k <= steps; ++k)
            carry(double(k) / kUpSteps);
        // Blends the rotations from both ends of a step, so that the rate is continuous.
        const glm::dvec3 view0 = view, up0 = up, here = glm::normalize(look(span, u));
        carry((steps + 1.0) / kUpSteps);
        const double weight = hermite::Weights(u * kUpSteps - steps).second;
        return glm::normalize(glm::mix(turned(up0, view0, here), turned(up, view, here), weight));
    }

    /// Roll of the up direction between two keys, radians.
    double roll(const Span& span) const {
        const glm::dvec3 view = glm::normalize(look_at_key(span.first + 1));
        return angle_about(view, carried_up(span, 1), up_[span.first + 1]);
    }

    glm::dvec3 up(const Span& span, std::size_t i, double u) const {
        // The rolls of this span and its neighbours form a curve with its own rates at the keys.
        const std::size_t spans = up_.size() - 1;
        const bool before = i > 0 || loop_, after = i + 1 < spans || loop_;
        hermite::Keys<double> rolls;
        rolls.times = {0, seconds(i)};
        rolls.values = {0, roll(span)};
        if (before) {
            const std::size_t k = (i + spans - 1) % spans;
            rolls.times.insert(rolls.times.begin(), -seconds(k));
            rolls.values.insert(rolls.values.begin(), -roll(span_at(k)));
        }
        if (after) {
            const std::size_t k = (i + 1) % spans;
            rolls.times.push_back(rolls.times.back() + seconds(k));
            rolls.values.push_back(rolls.values.back() + roll(span_at(k)));
        }
        const double rolled = hermite::value(rolls, before ? 1 : 0, u);
        return turned_about(carried_up(span, u), rolled, glm::normalize(look(span, u)));
    }

    bool loop_;
    hermite::Keys<glm::dvec3> eye_, target_;
    hermite::Keys<double> fov_;
    std::optional<glm::dvec3> upright_;
    std::vector<glm::dvec3> up_;  ///< up of each key: unit, perpendicular to its view
};

/// Index of the last of the ascending times that is <= `time`.
std::size_t key_before(const std::vector<double>& times, double time) {
    return static_cast<std::size_t>(std::upper_bound(times.begin(), times.end(), time) - times.begin()) - 1;
}

void check_positive(const char* what, const char* field, double value) {
    if (!(value > 0 && std::isfinite(value))) fail("{} {}: {} is not greater than 0 and finite", what, field, value);
}

glm::dvec3 unit(const char* what, const char* field, const glm::dvec3& v) {
    if (!(glm::length(v) > 0 && std::isfinite(glm::length(v))))
        fail("{} {}: ({}, {}, {}) is not a finite vector other than 0", what, field, v.x, v.y, v.z);
    return glm::normalize(v);
}

/// Point of the centripetal Catmull-Rom curve between p[1] and p[2] (Barry and Goldman's pyramid), u in [0, 1].
glm::dvec3 catmull_rom(const std::array<glm::dvec3, 4>& p, double u) {
    std::array<double, 4> t{};
    for (std::size_t k = 1; k < 4; ++k)
        t[k] = t[k - 1] + std::sqrt(glm::length(p[k] - p[k - 1]));
    const double at = t[1] + u * (t[2] - t[1]);
    const auto between = [&](const glm::dvec3& a, const glm::dvec3& b, double ta, double tb) {
        return (a * (tb - at) + b * (at - ta)) / (tb - ta);
    };
    const glm::dvec3 a = between(p[0], p[1], t[0], t[1]), b = between(p[1], p[2], t[1], t[2]),
                     c = between(p[2], p[3], t[2], t[3]);
    return between(between(a, b, t[0], t[2]), between(b, c, t[1], t[3]), t[1], t[2]);
}

/// A curve as a fine polyline, with the arc length at each point.
struct MeasuredCurve {
    std::vector<glm::dvec3> points;
    std::vector<double> lengths;

    /// The point at an arc length; continues straight beyond the end.
    glm::dvec3 at(double length) const {
        const std::size_t last = points.size() - 1;
        const std::size_t i = std::min(key_before(lengths, std::max(length, 0.0)), last - 1);
        return glm::mix(points[i], points[i + 1], (length - lengths[i]) / (lengths[i + 1] - lengths[i]));
    }
};

MeasuredCurve measured_curve(const std::vector<glm::dvec3>& points) {
    constexpr int kSamples = 512;  // per span
    MeasuredCurve curve;
    const auto add = [&](const glm::dvec3& p) {
        const double step = curve.points.empty() ? 0 : glm::length(p - curve.points.back());
        if (!curve.points.empty() && !(step > 0)) return;
        curve.lengths.push_back(curve.points.empty() ? 0 : curve.lengths.back() + step);
        curve.points.push_back(p);
    };
    add(points.front());
    const std::size_t last = points.size() - 1;
    for (std::size_t i = 0; i < last; ++i) {
        const glm::dvec3 before = i > 0 ? points[i - 1] : 2.0 * points[0] - points[1];
        const glm::dvec3 after = i + 1 < last ? points[i + 2] : 2.0 * points[last] - points[last - 1];
        for (int k = 1; k < kSamples; ++k)
            add(catmull_rom({before, points[i], points[i + 1], after}, double(k) / kSamples));
        add(points[i + 1]);
    }
    return curve;
}

}  // namespace

void validate(const CameraPath& path) {
    if (path.keys.empty()) fail("camera path: it has no keys; expected at least one");
    for (std::size_t i = 0; i < path.keys.size(); ++i) {
        const CameraKey& key = path.keys[i];
        if (!std::isfinite(key.time)) fail("camera path key {} time: {} is not finite", i, key.time);
        if (i > 0 && !(key.time > path.keys[i - 1].time))
            fail("camera path key {} time: {} s is not after the key before, {} s", i, key.time, path.keys[i - 1].time);
        if (key.target == key.eye)
            fail("camera path key {} target: ({}, {}, {}) equals the eye", i, key.target.x, key.target.y, key.target.z);
        unit(fmt::format("camera path key {}", i).c_str(), "up", key.up);
        try {
            camera_frame(camera_of(key));
        } catch (const Error& error) {
            fail("camera path key {}: {}", i, error.what());
        }
    }
    const CameraKey &first = path.keys.front(), &last = path.keys.back();
    if (path.loop && (path.keys.size() < 2 || first.eye != last.eye || first.target != last.target ||
                      first.up != last.up || first.fov != last.fov))
        fail("camera path loop: the last key's camera differs from the first key's; expected the same camera");
}

double duration(const CameraPath& path) {
    return path.keys.empty() ? 0 : path.keys.back().time - path.keys.front().time;
}

Camera camera_at(const CameraPath& path, double time) {
    validate(path);
    if (!std::isfinite(time)) fail("camera path: the time {} s is not finite", time);
    const std::vector<CameraKey>& keys = path.keys;
    const double start = keys.front().time;
    if (path.loop) {
        time = start + std::fmod(time - start, duration(path));
        if (time < start) time += duration(path);
    }
    time = std::clamp(time, start, keys.back().time);
    if (keys.size() == 1) {
        Camera camera = camera_of(keys[0]);
        camera.up = camera_frame(camera).up;
        return camera;
    }
    std::vector<double> times;
    for (const CameraKey& key : keys)
        times.push_back(key.time);
    const std::size_t i = std::min(key_before(times, time), keys.size() - 2);
    return Curves(path).at(i, (time - times[i]) / (times[i + 1] - times[i]));
}

CameraPath orbit_path(const Orbit& orbit) {
    constexpr double kDegreesPerKey = 5;
    const glm::dvec3 axis = unit("orbit", "axis", orbit.axis);
    check_positive("orbit", "seconds", orbit.seconds);
    if (!(std::abs(orbit.degrees) > 0 && std::abs(orbit.degrees) <= 36000))
        fail("orbit degrees: {} is 0 or outside [-36000, 36000]", orbit.degrees);
    const CameraFrame start = camera_frame(orbit.start);
    const int spans = std::max(4, static_cast<int>(std::ceil(std::abs(orbit.degrees) / kDegreesPerKey - 1e-9)));
    CameraPath path;
    path.loop = std::fmod(orbit.degrees, 360.0) == 0;
    for (int k = 0; k <= spans; ++k) {
        const double angle = path.loop && k == spans ? 0 : glm::radians(orbit.degrees * k / spans);
        path.keys.push_back({orbit.seconds * k / spans,
                             orbit.center + turned_about(start.eye - orbit.center, angle, axis), orbit.center,
                             turned_about(start.up, angle, axis), orbit.start.fov_y});
    }
    validate(path);
    return path;
}

CameraPath fly_through(const FlyThrough& flight) {
    constexpr int kKeys = 64;  // per span
    check_positive("fly through", "seconds", flight.seconds);
    check_positive("fly through", "look_ahead", flight.look_ahead);
    std::vector<glm::dvec3> points;
    for (const glm::dvec3& p : flight.points) {
        if (!(std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z)))
            fail("fly through point {}: ({}, {}, {}) is not finite", &p - flight.points.data(), p.x, p.y, p.z);
        if (points.empty() || p != points.back()) points.push_back(p);
    }
    if (points.size() < 2) fail("fly through: there are {} different points; expected at least 2", points.size());
    const MeasuredCurve curve = measured_curve(points);
    const double length = curve.lengths.back();
    const int spans = kKeys * static_cast<int>(points.size() - 1);
    CameraPath path;
    for (int k = 0; k <= spans; ++k) {
        const double at = length * k / spans;
        path.keys.push_back(
            {flight.seconds * k / spans, curve.at(at), curve.at(at + flight.look_ahead), flight.up, flight.fov});
    }
    validate(path);
    return path;
}

void validate(const AnimatedParameter& parameter) {
    const auto& values = parameter.values;
    if (values.empty()) fail("animated {}: it has no values; expected at least one", parameter.key);
    for (std::size_t i = 0; i < values.size(); ++i) {
        if (!std::isfinite(values[i].time) || !std::isfinite(values[i].value))
            fail("animated {}, key {}: {} at {} s is not finite", parameter.key, i, values[i].value, values[i].time);
        if (i > 0 && !(values[i].time > values[i - 1].time))
            fail("animated {}, key {}: {} s is not after the key before, {} s", parameter.key, i, values[i].time,
                 values[i - 1].time);
    }
}

double value_at(const AnimatedParameter& parameter, double time) {
    validate(parameter);
    if (!std::isfinite(time)) fail("animated {}: the time {} s is not finite", parameter.key, time);
    hermite::Keys<double> keys;
    for (const AnimatedParameter::Key& key : parameter.values) {
        keys.times.push_back(key.time);
        keys.values.push_back(key.value);
    }
    if (time <= keys.times.front() || keys.times.size() == 1) return keys.values.front();
    if (time >= keys.times.back()) return keys.values.back();
    const std::size_t i = key_before(keys.times, time);
    return hermite::value(keys, i, (time - keys.times[i]) / (keys.times[i + 1] - keys.times[i]));
}

}  // namespace edgesplat
