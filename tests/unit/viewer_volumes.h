// Cavities of known shape for the tests of navigation. `room` is the signed distance to the wall in mm, > 0 in the
// cavity. Its argument is a position in the volume's own frame (index times spacing, mm).
#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <glm/glm.hpp>
#include <memory>
#include <string>

#include "engine/scene/scene.h"
#include "engine/volume/volume.h"

namespace edgesplat::viewer_test {

using Room = std::function<double(const glm::dvec3&)>;

/// A rotation about all axes; orthonormal.
inline const glm::dmat3 kTurned{{0.8, 0.6, 0}, {-0.48, 0.64, 0.6}, {0.36, -0.48, 0.8}};

struct Cavity {
    std::string name;
    glm::ivec3 dims{48};
    glm::dvec3 spacing{1};
    glm::dmat3 axes{1};  ///< directions of the volume's axes, orthonormal
    glm::dvec3 origin{0};
    Room room;
    glm::dvec3 inside{0};  ///< a place with room around it, own frame
    double blur = 0.7;     ///< mm: standard deviation of the edge; 0: binary

    glm::dvec3 to_world(const glm::dvec3& own) const { return origin + axes * own; }
    glm::dvec3 to_own(const glm::dvec3& world) const { return glm::transpose(axes) * (world - origin); }
    double room_at(const glm::dvec3& world) const { return room(to_own(world)); }
};

/// 1 in matter, 0 in the cavity; the surface is at 0.5.
inline std::shared_ptr<const Volume> sampled(const Cavity& cavity) {
    auto volume = std::make_shared<Volume>();
    volume->name = cavity.name;
    volume->geometry.dims = cavity.dims;
    volume->geometry.origin = cavity.origin;
    for (int axis = 0; axis < 3; ++axis)
        volume->geometry.index_to_world_axes[axis] = cavity.axes[axis] * cavity.spacing[axis];
    for (int z = 0; z < cavity.dims.z; ++z)
        for (int y = 0; y < cavity.dims.y; ++y)
            for (int x = 0; x < cavity.dims.x; ++x) {
                const double s = cavity.room(glm::dvec3(x, y, z) * cavity.spacing);
                const double v =
                    cavity.blur > 0 ? 0.5 * std::erfc(s / (cavity.blur * std::sqrt(2.0))) : (s < 0 ? 1.0 : 0.0);
                volume->values.push_back(static_cast<float>(v));
            }
    finish_volume(*volume);
    return volume;
}

/// Opaque from 0.5 on.
inline Scene solid_scene(double extinction = 8) {
    Scene scene;
    scene.iso_values = {0.5};
    scene.materials = {{}, {{1.0, 0.8, 0.6}, extinction}};
    return scene;
}

/// An independent trilinear interpolation at a world position.
inline double trilinear(const Volume& volume, const glm::dvec3& world) {
    const glm::dvec3 last(volume.geometry.dims - 1);
    const glm::dvec3 p = glm::clamp(volume.geometry.to_index(world), glm::dvec3(0), last);
    const glm::ivec3 cell = glm::min(glm::ivec3(p), volume.geometry.dims - 2);
    double sum = 0;
    for (int k = 0; k < 8; ++k) {
        const glm::ivec3 step{k & 1, k >> 1 & 1, k >> 2 & 1}, i = cell + step;
        const glm::dvec3 t = p - glm::dvec3(cell), w = glm::mix(1.0 - t, t, glm::dvec3(step));
        sum += w.x * w.y * w.z * static_cast<double>(volume.at(i.x, i.y, i.z));
    }
    return sum;
}

inline double box_distance(const glm::dvec3& p, const glm::dvec3& center, const glm::dvec3& half) {
    const glm::dvec3 q = glm::abs(p - center) - half;
    return glm::length(glm::max(q, glm::dvec3(0))) + std::min(std::max({q.x, q.y, q.z}), 0.0);
}

inline Cavity hollow_ball(int size = 48, double radius = 16) {
    const glm::dvec3 c((size - 1) / 2.0);
    return {"hollow ball",
            glm::ivec3(size),
            glm::dvec3(1),
            glm::dmat3(1),
            glm::dvec3(0),
            [=](const glm::dvec3& x) { return radius - glm::length(x - c); },
            c};
}

inline Cavity straight_tube() {
    return {"tube",
            {48, 48, 64},
            glm::dvec3(1),
            kTurned,
            {5, -7, 30},
            [](const glm::dvec3& x) {
                const double side = 6.3 - glm::length(glm::dvec2(x) - glm::dvec2(23.2, 24.1));
                return std::min(side, 26.0 - std::abs(x.z - 31.5));
            },
            {23.2, 24.1, 31.5}};
}

/// A quarter of a torus with the major radius 30 around (6, 6, *), closed at its ends.
inline constexpr double kBend = 30;
inline Cavity bent_tube(const glm::dvec3& spacing = glm::dvec3(1), double radius = 5.5) {
    const glm::dvec3 size(48, 48, 48);
    return {"bent tube",
            glm::ivec3(size / spacing),
            spacing,
            glm::dmat3(1),
            glm::dvec3(0),
            [=](const glm::dvec3& x) {
                const glm::dvec2 p(x.x - 6, x.y - 6);
                const double tube = radius - std::hypot(glm::length(p) - kBend, x.z - 24);
                return std::min({tube, p.x + 0.0, p.y + 0.0});
            },
            {6 + kBend * std::cos(0.7), 6 + kBend * std::sin(0.7), 24}};
}

/// Room between two balls.
inline Cavity shell() {
    const glm::dvec3 c(23.5);
    return {"shell",
            glm::ivec3(48),
            glm::dvec3(1),
            glm::dmat3(1),
            {100, 200, -300},
            [=](const glm::dvec3& x) {
                const double r = glm::length(x - c);
                return std::min(21 - r, r - 14);
            },
            c + glm::dvec3(17.5, 0, 0)};
}

/// 2 x 2 x 2 rooms of side 14 mm, 24 mm apart, with passages of side 5 mm between some.
inline Cavity maze(const glm::dvec3& spacing = glm::dvec3(1)) {
    const auto room = [](const glm::dvec3& p) {
        double outside = 1e9;  // distance to the union of boxes, below 0 in one
        const auto add = [&](const glm::dvec3& center, const glm::dvec3& half) {
            outside = std::min(outside, box_distance(p, center, half));
        };
        for (int z = 0; z < 2; ++z)
            for (int y = 0; y < 2; ++y)
                for (int x = 0; x < 2; ++x) {
                    const glm::dvec3 c = 11.5 + 24.0 * glm::dvec3(x, y, z);
                    add(c, glm::dvec3(7));
                    if (x == 0) add(c + glm::dvec3(12, 0, 0), {12, 2.5, 2.5});
                    if (y == 0 && x == z) add(c + glm::dvec3(0, 12, 0), {2.5, 12, 2.5});
                    if (z == 0 && x == y) add(c + glm::dvec3(0, 0, 12), {2.5, 2.5, 12});
                }
        return -outside;
    };
    return {"maze",          glm::ivec3(glm::dvec3(48) / spacing), spacing, glm::dmat3(1), glm::dvec3(0), room,
            glm::dvec3(11.5)};
}

}  // namespace edgesplat::viewer_test
