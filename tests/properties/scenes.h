// Small scenes for the property and image tests.
#pragma once

#include <algorithm>

#include "engine/image/image_compare.h"
#include "engine/volume/analytic_volumes.h"
#include "tests/properties/measuring.h"

namespace edgesplat::test {

/// Looks from `eye` at `target`, both in index space; `up` in world space.
inline Camera look(const Volume& volume, const glm::dvec3& eye, const glm::dvec3& target, double fov,
                   const glm::dvec3& up = {0.1, 0.05, 1}) {
    Camera camera;
    camera.eye = volume.geometry.to_world(eye);
    camera.direction = volume.geometry.to_world(target) - camera.eye;
    camera.up = up;
    camera.fov_y = fov;
    return camera;
}

/// The volume with other axes and origin.
inline VolumePointer placed(const VolumePointer& volume, const glm::dmat3& axes, const glm::dvec3& origin = {}) {
    const auto copy = std::make_shared<Volume>(*volume);
    copy->geometry.index_to_world_axes = axes;
    copy->geometry.origin = origin;
    finish_volume(*copy);
    return copy;
}

/// Volume, camera and light transformed together by a linear map (columns: images of the world axes) and a shift.
inline Shot moved(Shot shot, const glm::dmat3& map, const glm::dvec3& shift = {}) {
    const auto& g = shot.volume->geometry;
    shot.volume = placed(shot.volume, map * g.index_to_world_axes, map * g.origin + shift);
    shot.camera.eye = map * shot.camera.eye + shift;
    shot.camera.direction = map * shot.camera.direction;
    shot.camera.up = map * shot.camera.up;
    for (Light& light : shot.scene.lights)
        light.direction = map * light.direction;
    return shot;
}

/// An opaque torus and a translucent second material, lit by a headlight, completely visible.
inline Shot torus_shot() {
    Shot shot;
    shot.volume = std::make_shared<const Volume>(sample(torus_scene({30, 28, 20}, {14.3, 13.6, 9.4}, 8.2, 4.1)));
    shot.scene.iso_values = {0.2, 0.5};
    shot.scene.materials = {{}, {{0.2, 0.5, 1}, 0.15}, {{1, 0.85, 0.7}, 2}};
    shot.camera = look(*shot.volume, {15, -24, 26}, {14, 13, 9}, 40);
    shot.width = shot.height = 96;
    return shot;
}

/// An opaque ball, radius 8 around (22, 24, 18), over a plate z < 5.4; voxels of 1 mm. One directional light with
/// shadows, and no other light.
inline Shot ball_over_plate_shot() {
    Volume volume;
    volume.geometry.dims = {48, 48, 32};
    for (int z = 0; z < 32; ++z)
        for (int y = 0; y < 48; ++y)
            for (int x = 0; x < 48; ++x) {
                const double inside = std::max(8 - glm::length(glm::dvec3(x, y, z) - glm::dvec3(22, 24, 18)), 5.4 - z);
                volume.values.push_back(static_cast<float>(std::clamp(0.5 + inside, 0.0, 1.0)));
            }
    finish_volume(volume);
    Shot shot;
    shot.volume = std::make_shared<const Volume>(std::move(volume));
    shot.scene.iso_values = {0.5};
    shot.scene.materials = {{}, {{1, 0.85, 0.7}, 3}};
    shot.scene.ambient = 0;
    shot.scene.lights = {directional_light({-1, -0.3, 1.2})};
    shot.scene.lights[0].shadows = true;
    shot.camera = look(*shot.volume, {24, -40, 55}, {24, 25, 9}, 40);
    shot.width = shot.height = 128;
    return shot;
}

/// Whether every channel of every pixel is finite and within [low, high].
inline bool within(const Image& image, float low, float high) {
    for (const float v : image.pixels)
        if (!(v >= low && v <= high)) return false;
    return true;
}

inline Image flipped(const Image& image) {
    Image mirror = image;
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x)
            for (int c = 0; c < image.channels; ++c)
                mirror.at(x, y, c) = image.at(image.width - 1 - x, y, c);
    return mirror;
}

}  // namespace edgesplat::test
