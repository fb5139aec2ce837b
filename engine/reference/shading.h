// Shades a splat, or a point of a surface, as seen from the eye (docs/method/shading.md).
#pragma once

#include <array>

#include "engine/scene/scene.h"

namespace edgesplat::reference {

struct Surface {
    glm::dvec3 color{1};  ///< linear light
    LightResponse response{};
    glm::dvec3 normal{0};    ///< world, unit; 0: no normal
    glm::dvec3 position{0};  ///< world mm
    double depth = 0;        ///< along the view axis, mm
};

/// Shares of the light that reach a surface, [0, 1].
struct Reach {
    double ambient = 1;
    std::array<double, kMaxLights> lights{1, 1, 1, 1};
};

/// Colour of a surface under the scene's lights (Blinn 1977), linear light. Without lights the surface's own colour.
glm::dvec3 lit(const Scene& scene, const Surface& surface, const glm::dvec3& eye, const Reach& reach = {});

/// lit(), then silhouette, then fog.
glm::dvec3 shade(const Scene& scene, const Surface& surface, const glm::dvec3& eye, const Reach& reach = {});

}  // namespace edgesplat::reference
