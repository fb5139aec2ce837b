// Builtin scenes with their exact pictures.
#pragma once

#include <cmath>
#include <string>

#include "engine/accuracy/metrics.h"
#include "engine/reference/truth.h"
#include "tests/properties/scenes.h"

namespace edgesplat::test {

/// A picture to draw, and its exact version.
struct Exact {
    Shot shot;
    Image truth;
};

/// A shot of a scene with its exact picture.
inline Exact exact_shot(const AnalyticScene& scene, const Shot& shot) {
    reference::DirectOptions options;
    options.tolerance = 1e-3;
    return {shot,
            reference::truth(scene, shot.volume->geometry, shot.scene, shot.camera, shot.width, shot.height, options)
                .image};
}

/// An opaque scene, completely visible in 120 x 120 pixels. With two iso-values, `layer` is the material between them.
inline Exact exact_scene(const AnalyticScene& scene, double extinction = 8, const Material& layer = {}) {
    Shot shot;
    shot.volume = std::make_shared<const Volume>(sample(scene));
    shot.scene.iso_values = scene.iso_values;
    shot.scene.materials.resize(scene.iso_values.size() + 1);
    if (scene.iso_values.size() == 2) shot.scene.materials[1] = layer;
    shot.scene.materials.back() = {{1, 0.9, 0.8}, extinction};
    const glm::dvec3 middle = glm::dvec3(scene.dims - 1) / 2.0;
    shot.camera =
        look(*shot.volume, middle + 2.3 * glm::length(middle) * glm::normalize(glm::dvec3(3.8, -5.2, 3)), middle, 32);
    shot.width = shot.height = 120;
    return exact_shot(scene, shot);
}

/// A builtin scene by name.
inline Exact exact_scene(const std::string& name, double extinction = 8) {
    return exact_scene(builtin_scene("builtin:" + name), extinction);
}

/// PSNR of RGBA against the truth.
inline double decibels(const Image& image, const Image& truth) {
    return -20 * std::log10(accuracy::image_error(image, truth).rms);
}

}  // namespace edgesplat::test
