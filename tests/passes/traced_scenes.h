// Scenes with surfaces that no quadric fits within a kernel.
#pragma once

#include "tests/passes/pass_fixture.h"

namespace edgesplat::test {

/// An opaque plate of three voxels with a round opening of radius 1, an opaque gyroid, and an opaque thin wall that the
/// border cuts.
inline std::vector<PassScene> traced_scenes() {
    std::vector<PassScene> scenes(3);
    auto& plate = scenes[0];
    plate.name = "opening";
    AnalyticScene slab = slab_scene({24, 24, 20}, {0.1, 0.2, 1}, {11.6, 11.3, 9.7}, 3);
    slab.value = [whole = slab.value](const glm::dvec3& x) {
        const double r = std::hypot(x.x - 11.6, x.y - 11.3);
        return whole(x) * (1 - 0.5 * std::erfc((r - 1) / (0.7 * std::sqrt(2.0))));
    };
    plate.volume = sample(slab);
    plate.scene.iso_values = {0.5};
    plate.scene.materials = {{{0, 0, 0}, 0}, {{1, 0.85, 0.75}, 4}};
    look_at(plate, {9, 14, -6}, {11.6, 11.3, 9.7}, 40);

    auto& gyroid = scenes[1];
    gyroid.name = "gyroid";
    const AnalyticScene waves = resized(analytic_scene("gyroid"), {26, 24, 25});
    gyroid.volume = sample(waves);
    gyroid.scene.iso_values = {static_cast<float>(waves.iso_values[0])};
    gyroid.scene.materials = {{{0, 0, 0}, 0}, {{0.8, 0.9, 1}, 4}};
    look_at(gyroid, {34, -14, 22}, {12, 12, 12}, 42);

    auto& cut = scenes[2];
    cut.name = "cut";
    cut.volume = sample(slab_scene({24, 22, 24}, {1, 0.2, 0.1}, {11.6, 10.5, 11.5}, 1.5));
    cut.scene.iso_values = {0.5};
    cut.scene.materials = plate.scene.materials;
    look_at(cut, {16, -9, 14}, {13, 4, 11.5}, 50);
    for (PassScene& scene : scenes)
        scene.settings.opaque = OpaqueMatter::Kernels;
    return scenes;
}

}  // namespace edgesplat::test
