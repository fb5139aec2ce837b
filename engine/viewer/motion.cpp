#include "engine/viewer/motion.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/quaternion.hpp>
#include <utility>

namespace edgesplat::viewer {
namespace {

constexpr double kLongestStep = 10, kSubstep = 1.0 / 120;                                                  // s
constexpr double kMoveTime = 0.12, kLookTime = 0.04, kOrbitTime = 0.06, kPanTime = 0.05, kZoomTime = 0.1;  // s
constexpr double kRollRate = 1.2;                                                                          // radians/s
constexpr double kZoomFactor = 0.85;                                                                       // per step
constexpr double kLevelling = 2;  // of a roll, per radian of orbit
constexpr double kEyeReach = 8;   // largest distance of the eye from the volume, in extents of the volume
constexpr double kHomeSeconds = 0.8;
constexpr double kPole = glm::half_pi<double>();

bool finite(const glm::dvec3& v) {
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

double bounded(double v, double most) {
    return std::isfinite(v) ? std::clamp(v, -most, most) : 0;
}

template <typename Vector>
Vector bounded(Vector v, double most) {
    for (int i = 0; i < Vector::length(); ++i)
        v[i] = bounded(v[i], most);
    return v;
}

Controls sane(const Controls& given) {
    Controls c;
    c.move = bounded(given.move, 1);
    if (glm::length(c.move) > 1) c.move = glm::normalize(c.move);
    c.look = bounded(given.look, 10);
    c.roll = bounded(given.roll, 1);
    c.orbit = bounded(given.orbit, 10);
    c.pan = bounded(given.pan, 10);
    c.zoom = bounded(given.zoom, 100);
    c.boost = std::isfinite(given.boost) ? std::clamp(given.boost, 0.0, 1000.0) : 1;
    return c;
}

bool touched(const Controls& c) {
    return c.move != glm::dvec3(0) || c.look != glm::dvec2(0) || c.roll != 0 || c.orbit != glm::dvec2(0) ||
           c.pan != glm::dvec2(0) || c.zoom != 0;
}

/// v rotated right-handed about a unit axis (Rodrigues).
glm::dvec3 turned(const glm::dvec3& v, double angle, const glm::dvec3& axis) {
    const double cosine = std::cos(angle), sine = std::sin(angle);
    return v * cosine + glm::cross(axis, v) * sine + axis * (glm::dot(axis, v) * (1 - cosine));
}

/// Delays an amount that is given at a constant rate, exponentially and exactly. Returns the part that arrives within
/// `dt`; `pending` keeps the rest.
template <typename Amount>
Amount arriving(Amount& pending, const Amount& rate, double dt, double delay) {
    const Amount steady = rate * delay;
    const Amount left = steady + (pending - steady) * std::exp(-dt / delay);
    const Amount arrived = pending + rate * dt - left;
    pending = left;
    return arrived;
}

double smoother(double t) {
    return t * t * t * (t * (t * 6 - 15) + 10);
}

/// A camera as a rotation, and the place of a centre in its frame.
struct Pose {
    glm::dquat turn;
    glm::dvec3 center;  ///< in the camera's frame
    Pose(const Camera& camera, const glm::dvec3& world_center) {
        const CameraFrame f = camera_frame(camera);
        const glm::dmat3 axes(f.right, f.up, -f.forward);
        turn = glm::quat_cast(axes);
        center = glm::transpose(axes) * (world_center - f.eye);
    }
};

/// Interpolates between two places of a centre: directions and distances separately, so that nothing rushes past.
glm::dvec3 between(const glm::dvec3& a, const glm::dvec3& b, double s) {
    const double la = glm::length(a), lb = glm::length(b);
    if (!(la > 0 && lb > 0) || glm::dot(a, b) < -0.5 * la * lb) return glm::mix(a, b, s);
    return glm::normalize(glm::mix(a / la, b / lb, s)) * std::exp(std::lerp(std::log(la), std::log(lb), s));
}

}  // namespace

Motion::Motion() = default;

double Motion::extent() const {
    if (walls_) {
        const VolumeGeometry& g = walls_->geometry();
        return glm::length(g.index_to_world_axes * glm::dvec3(g.dims));
    }
    return std::max(glm::length(home_.eye - home_center_), 1e-6);
}

void Motion::set_home(const Camera& home, const glm::dvec3& center) {
    const CameraFrame frame = camera_frame(home);
    home_ = home;
    home_center_ = center;
    has_home_ = true;
    const double length = glm::length(home.up);
    const bool along = !(length > 0) || std::abs(glm::dot(home.up / length, frame.forward)) > 1 - 1e-9;
    axis_ = along ? frame.up : home.up / length;
}

void Motion::set_walls(std::shared_ptr<const Walls> walls) {
    walls_ = std::move(walls);
    entered_ = false;
}

void Motion::set_mode(MotionMode mode) {
    if (mode == mode_) return;
    mode_ = mode;
    momentum_ = {};
    entered_ = false;
    if (mode == MotionMode::Fly) return;
    const CameraFrame frame = camera_frame(camera_);
    const glm::dvec3 to_center = center_ - camera_.eye;
    const double away = glm::length(to_center);
    if (away > 0 && glm::dot(to_center / away, frame.forward) > 0.9998) return;
    const double limit = extent();
    const double ahead = walls_ ? walls_->free_distance(camera_.eye, frame.forward, limit) : limit;
    center_ =
        camera_.eye + frame.forward * (ahead > 0 && ahead < limit ? ahead : std::clamp(away, 1e-3 * limit, limit));
}

void Motion::set_collisions(bool on) {
    collisions_ = on;
    entered_ = false;
}

void Motion::set_fov(double degrees) {
    if (degrees >= 1 && degrees <= 170) camera_.fov_y = degrees;
}

void Motion::set_center(const glm::dvec3& center) {
    if (finite(center)) center_ = center;
}

void Motion::jump(const Camera& camera) {
    const CameraFrame frame = camera_frame(camera);
    if (!has_home_) {
        const double away = glm::length(center_ - camera_.eye);
        center_ = camera.eye + frame.forward * away;
        set_home(camera, center_);
    }
    camera_ = camera;
    momentum_ = {};
    flight_.reset();
    entered_ = false;
}

void Motion::fly_to(const Camera& camera, const glm::dvec3& center, double seconds) {
    const CameraFrame frame = camera_frame(camera), here = camera_frame(camera_);
    momentum_ = {};
    if (!(seconds > 0 && std::isfinite(seconds))) {
        jump(camera);
        set_center(center);
        return;
    }
    Flight flight{camera_, camera, center_, finite(center) ? center : camera.eye + frame.forward, seconds, 0};
    // If the eye does not look at the centre, a point ahead replaces it; otherwise the eye would swing about.
    const glm::dvec3 to_center = center_ - camera_.eye;
    if (!(glm::dot(to_center, here.forward) > 0.8 * glm::length(to_center)))
        flight.from_center = camera_.eye + here.forward * glm::length(flight.to_center - camera.eye);
    flight_ = flight;
}

void Motion::home() {
    if (has_home_) set_home(home_, home_center_);
    fly_to(home_, home_center_, kHomeSeconds);
}

bool Motion::moving() const {
    const Momentum& m = momentum_;
    return flight_ || m.velocity != glm::dvec3(0) || m.roll_rate != 0 || m.look != glm::dvec2(0) ||
           m.orbit != glm::dvec2(0) || m.pan != glm::dvec2(0) || m.zoom != 0;
}

double Motion::speed() const {
    double room = std::numeric_limits<double>::infinity();
    if (walls_) room = std::abs(walls_->distance(camera_.eye));
    if (!std::isfinite(room)) room = glm::length(center_ - camera_.eye);
    const double most = extent() / 2, least = walls_ ? 5 * walls_->voxel() : 5e-3 * extent();
    return std::clamp(2 * room, std::min(least, most), most);
}

void Motion::step(const Controls& given, double seconds) {
    if (!(seconds > 0 && std::isfinite(seconds))) return;
    seconds = std::min(seconds, kLongestStep);
    const Controls controls = sane(given);
    const bool held = touched(controls);
    if (held) flight_.reset();
    if (flight_) return travel(seconds);
    if (!held && !moving()) return;
    Controls rates = controls;
    rates.look /= seconds;
    rates.orbit /= seconds;
    rates.pan /= seconds;
    rates.zoom /= seconds;
    const int count = std::max(1, static_cast<int>(std::ceil(seconds / kSubstep - 1e-9)));
    for (int i = 0; i < count; ++i) {
        const Camera before = camera_;
        const glm::dvec3 center_before = center_;
        glide(rates, seconds / count);
        if (finite(camera_.eye) && finite(camera_.direction) && finite(camera_.up) && finite(center_)) continue;
        camera_ = before;
        center_ = center_before;
        momentum_ = {};
    }
    if (!held) settle();
}

void Motion::travel(double seconds) {
    Flight& flight = *flight_;
    flight.elapsed += seconds;
    entered_ = false;
    if (flight.elapsed >= flight.seconds) {
        camera_ = flight.to;
        center_ = flight.to_center;
        flight_.reset();
        return;
    }
    const double s = smoother(flight.elapsed / flight.seconds);
    const Pose from(flight.from, flight.from_center), to(flight.to, flight.to_center);
    const glm::dmat3 axes = glm::mat3_cast(glm::slerp(from.turn, to.turn, s));
    center_ = glm::mix(flight.from_center, flight.to_center, s);
    camera_.eye = center_ - axes * between(from.center, to.center, s);
    camera_.direction = -axes[2];
    camera_.up = axes[1];
    camera_.fov_y = std::lerp(flight.from.fov_y, flight.to.fov_y, s);
}

void Motion::glide(const Controls& rates, double dt) {
    Momentum& m = momentum_;
    const CameraFrame frame = camera_frame(camera_);
    const double turned_roll = [&] {
        const double wanted = kRollRate * rates.roll, decay = std::exp(-dt / kMoveTime);
        const double way = wanted * dt + (m.roll_rate - wanted) * kMoveTime * (1 - decay);
        m.roll_rate = wanted + (m.roll_rate - wanted) * decay;
        return way;
    }();
    const bool moves = rates.move != glm::dvec3(0);
    glm::dvec3 wanted(0);
    if (moves)
        wanted = (frame.right * rates.move.x + frame.up * rates.move.y + frame.forward * rates.move.z) *
                 (speed() * rates.boost);
    const double decay = std::exp(-dt / kMoveTime);
    const glm::dvec3 way = wanted * dt + (m.velocity - wanted) * (kMoveTime * (1 - decay));
    m.velocity = wanted + (m.velocity - wanted) * decay;

    if (mode_ == MotionMode::Fly) {
        turn(arriving(m.look, rates.look, dt, kLookTime), turned_roll);
        if (way != glm::dvec3(0)) shift(way);
        return;
    }
    turn(glm::dvec2(0), turned_roll);
    axis_ = glm::normalize(turned(axis_, turned_roll, frame.forward));
    orbit_about_center(arriving(m.orbit, rates.orbit, dt, kOrbitTime));
    const glm::dvec2 pan = arriving(m.pan, rates.pan, dt, kPanTime);
    const CameraFrame now = camera_frame(camera_);
    double depth = glm::dot(center_ - camera_.eye, now.forward);
    if (!(depth > 0)) depth = glm::length(center_ - camera_.eye);
    const double height = 2 * now.tan_half_y * depth;
    shift(way + (now.right * pan.x + now.up * pan.y) * height);
    const double zoom = arriving(m.zoom, rates.zoom, dt, kZoomTime);
    if (zoom == 0) return;
    const glm::dvec3 from_center = camera_.eye - center_;
    const double least = walls_ ? walls_->voxel() / 2 : 1e-4 * extent(), most = kEyeReach * extent();
    const double old = std::max(glm::length(from_center), 1e-9 * extent());
    const double length = std::clamp(old * std::pow(kZoomFactor, zoom), std::min(least, old), std::max(most, old));
    const bool together = from_center == glm::dvec3(0);
    camera_.eye = center_ + (together ? -now.forward : glm::normalize(from_center)) * length;
}

void Motion::turn(const glm::dvec2& angles, double roll) {
    const CameraFrame f = camera_frame(camera_);
    const glm::dvec3 rotation = -angles.x * f.up + angles.y * f.right + roll * f.forward;
    const double angle = glm::length(rotation);
    if (!(angle > 0)) return;
    camera_.direction = glm::normalize(turned(f.forward, angle, rotation / angle));
    camera_.up = turned(f.up, angle, rotation / angle);
    camera_.up = camera_frame(camera_).up;
}

void Motion::orbit_about_center(const glm::dvec2& angles) {
    if (angles == glm::dvec2(0)) return;
    const CameraFrame f = camera_frame(camera_);
    // At a pole, the picture's own right axis is level.
    const glm::dvec3 across = glm::cross(f.forward, axis_);
    const bool at_pole = !(glm::length(across) > 1e-7);
    const glm::dvec3 level = at_pole ? f.right : glm::normalize(across), level_up = glm::cross(level, f.forward);
    const double height = std::asin(std::clamp(glm::dot(f.forward, axis_), -1.0, 1.0));
    const double climb = std::clamp(angles.y, height - kPole, height + kPole);
    if (climb != angles.y) momentum_.orbit.y = 0;
    const double roll = std::atan2(glm::dot(f.forward, glm::cross(level_up, f.up)), glm::dot(level_up, f.up));
    const double levelled = roll * std::expm1(-kLevelling * glm::length(angles));
    const auto carried = [&](const glm::dvec3& v) { return turned(turned(v, -climb, level), angles.x, axis_); };
    camera_.eye = center_ + carried(camera_.eye - center_);
    camera_.direction = glm::normalize(carried(f.forward));
    camera_.up = carried(turned(f.up, levelled, f.forward));
    camera_.up = camera_frame(camera_).up;
}

void Motion::shift(const glm::dvec3& way) {
    if (way == glm::dvec3(0)) return;
    const bool flies = mode_ == MotionMode::Fly;
    glm::dvec3 done = flies ? collided(way) : way;
    if (flies) {
        const glm::dvec3 held_back = way - done;
        const double length = glm::length(held_back);
        if (length > 1e-9 * glm::length(way)) {
            const glm::dvec3 into = held_back / length;
            momentum_.velocity -= into * std::max(0.0, glm::dot(momentum_.velocity, into));
        }
    }
    // The eye stays within kEyeReach extents of the volume.
    const glm::dvec3 middle = walls_ ? walls_->geometry().center() : home_center_;
    const glm::dvec3 next = camera_.eye + done - middle;
    const double far = std::max(kEyeReach * extent(), glm::length(camera_.eye - middle)), length = glm::length(next);
    if ((walls_ || has_home_) && length > far) done += next * (far / length - 1);
    camera_.eye += done;
    if (!flies) center_ += done;
}

glm::dvec3 Motion::collided(const glm::dvec3& way) {
    if (!collisions_ || !walls_ || !walls_->any()) return way;
    constexpr int kMostStrides = 256, kPushes = 6;
    const double voxel = walls_->voxel(), room = kClearance * voxel, least = kLeastClearance * voxel;
    const double whole = glm::length(way);
    /// Moves a place towards more room, by at most `limit` mm, and not backwards along `kept` (0: in any direction).
    const auto push = [&](glm::dvec3& at, double& distance, double limit, const glm::dvec3& kept) {
        for (int i = 0; i < kPushes && distance < room && limit > 0; ++i) {
            glm::dvec3 way_out = walls_->away(at);
            way_out -= kept * std::min(0.0, glm::dot(kept, way_out));
            if (glm::length(way_out) < 0.1) return;
            const double stride = std::min({room - distance, voxel / 4, limit});
            const glm::dvec3 next = at + glm::normalize(way_out) * stride;
            const double there = walls_->distance(next);
            if (!(there > distance)) return;
            at = next;
            distance = there;
            limit -= stride;
        }
    };
    // If the way ahead is free, for example into a passage, the walls of its mouth must not push the eye back.
    const auto is_free_ahead = [&](const glm::dvec3& from, const glm::dvec3& direction) {
        return walls_->distance(from + direction * voxel) > least / 2 &&
               walls_->distance(from + direction * (1.75 * voxel)) > least / 2;
    };
    glm::dvec3 at = camera_.eye;
    double distance = walls_->distance(at);
    if (!entered_ && distance > 0 && distance < least) push(at, distance, voxel, glm::dvec3(0));
    entered_ |= distance >= least;
    if (!entered_) return way;
    glm::dvec3 rest = way;
    for (int i = 0; i < kMostStrides; ++i) {
        const double length = glm::length(rest);
        if (!(length > 1e-9 * whole)) break;
        const double stride = std::min(length, std::max(voxel / 4, 0.8 * (distance - room)));
        glm::dvec3 next = at + rest * (stride / length);
        double there = walls_->distance(next);
        if (there < room) {
            const glm::dvec3 direction = rest / length;
            push(next, there, 2 * stride, is_free_ahead(at, direction) ? direction : glm::dvec3(0));
        }
        if (!(there >= least)) break;
        rest *= 1 - stride / length;
        at = next;
        distance = there;
    }
    return at - camera_.eye;
}

void Motion::settle() {
    Momentum& m = momentum_;
    const double short_way = walls_ ? 1e-4 * walls_->voxel() : 1e-7 * extent();
    constexpr double kSmallAngle = 1e-5;
    if (glm::length(m.velocity) * kMoveTime < short_way) m.velocity = glm::dvec3(0);
    if (std::abs(m.roll_rate) * kMoveTime < kSmallAngle) m.roll_rate = 0;
    if (glm::length(m.look) < kSmallAngle) m.look = glm::dvec2(0);
    if (glm::length(m.orbit) < kSmallAngle) m.orbit = glm::dvec2(0);
    if (glm::length(m.pan) < kSmallAngle) m.pan = glm::dvec2(0);
    if (std::abs(m.zoom) < 1e-4) m.zoom = 0;
}

}  // namespace edgesplat::viewer
