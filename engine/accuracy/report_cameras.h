// Finds the cameras of the accuracy report from the data alone: far, near, grazing a surface, and inside.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "engine/scene/camera.h"
#include "engine/scene/scene.h"
#include "engine/volume/volume.h"

namespace edgesplat::accuracy {

struct ReportCamera {
    std::string name;  ///< far, near, grazing, inside
    std::string what;  ///< its view and position, one sentence
    Camera camera;
};

/// A point where visible matter begins. Index space.
struct SurfaceHit {
    glm::dvec3 position{0};
    glm::dvec3 normal{0};  ///< unit, out of the matter, in index space
    double distance = 0;   ///< from the origin, voxels
};

/// The first such point on the ray origin + t u, t >= 0, by trilinear interpolation; u is a unit vector, both in index
/// space. nullopt if there is none, or the origin lies in matter.
std::optional<SurfaceHit> first_surface(const Volume& volume, const Scene& scene, const glm::dvec3& origin,
                                        const glm::dvec3& u);

/// The cameras depend only on volume, scene and size. No eye lies within 1.5 voxels of visible matter; a camera without
/// a suitable place is left out.
std::vector<ReportCamera> report_cameras(const Volume& volume, const Scene& scene, int width, int height);

}  // namespace edgesplat::accuracy
