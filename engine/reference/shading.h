// What a splat, or a point of a surface, looks like from the eye (method.md, Shading).
#pragma once

#include <array>

#include "engine/scene/scene.h"

namespace edgesplat::reference {

struct Surface {
    glm::dvec3 color{1};  ///< linear light
    LightResponse response{};
    glm::dvec3 normal{0};    ///< world, unit; 0 where there is none
    glm::dvec3 position{0};  ///< world mm
    double depth = 0;        ///< along the view axis, mm
};

/// Shares of the light that reach a surface, [0, 1].
struct Reach {
    double ambient = 1;
    std::array<double, kMaxLights> lights{1, 1, 1, 1};
};

/// What the scene's lights make of a surface (Blinn 1977): linear light. Without lights its colour.
glm::dvec3 lit(const Scene& scene, const Surface& surface, const glm::dvec3& eye, const Reach& reach = {});

/// That, then silhouette, then fog.
glm::dvec3 shade(const Scene& scene, const Surface& surface, const glm::dvec3& eye, const Reach& reach = {});

}  // namespace edgesplat::reference
