// Small volumes with known edges for the reference's tests. Index space, unit 1 voxel.
#pragma once

#include <cmath>
#include <glm/glm.hpp>

#include "engine/scene/camera.h"
#include "engine/scene/scene.h"
#include "engine/volume/volume.h"

namespace edgesplat::testing_volumes {

template <typename Value>
Volume sampled(const glm::ivec3& dims, const Value& value, const glm::dmat3& axes = glm::dmat3(1)) {
    Volume volume;
    volume.geometry.dims = dims;
    volume.geometry.index_to_world_axes = axes;
    for (int z = 0; z < dims.z; ++z) {
        for (int y = 0; y < dims.y; ++y) {
            for (int x = 0; x < dims.x; ++x)
                volume.values.push_back(static_cast<float>(value(glm::dvec3(x, y, z))));
        }
    }
    finish_volume(volume);
    return volume;
}

/// 1 deep inside (s << 0), 0 outside, blurred with a Gaussian of 0.7 voxel.
inline double blurred(double s) {
    return 0.5 * std::erfc(s / (0.7 * std::sqrt(2.0)));
}

inline Volume ball(int size, double radius) {
    const glm::dvec3 center((size - 1) / 2.0);
    return sampled(glm::ivec3(size), [&](const glm::dvec3& x) { return blurred(glm::length(x - center) - radius); });
}

/// Transparent below 0.5, `extinction` per mm above.
inline Scene solid_scene(double extinction) {
    Scene scene;
    scene.iso_values = {0.5};
    scene.materials = {{}, {{1.0, 0.8, 0.6}, extinction}};
    return scene;
}

/// Looks at the middle of the grid from `distance` mm.
inline Camera looking_at(const Volume& volume, const glm::dvec3& direction, double distance, double fov_y) {
    const glm::dvec3 middle = volume.geometry.to_world(glm::dvec3(volume.geometry.dims - 1) / 2.0);
    Camera camera;
    camera.direction = glm::normalize(direction);
    camera.eye = middle - distance * camera.direction;
    camera.fov_y = fov_y;
    return camera;
}

}  // namespace edgesplat::testing_volumes
