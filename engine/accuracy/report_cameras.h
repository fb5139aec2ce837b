// The cameras of the accuracy report, found from the data alone: far, near, grazing a surface, and inside.
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
    std::string what;  ///< what it shows and where it stands, one sentence
    Camera camera;
};

/// Where matter that is seen begins. Index space.
struct SurfaceHit {
    glm::dvec3 position{0};
    glm::dvec3 normal{0};  ///< unit, out of the matter, in index space
    double distance = 0;   ///< from the origin, voxels
};

/// The first such place on the ray origin + t u, t >= 0, by trilinear interpolation; u is a unit vector, both in index
/// space. Nothing where there is none, or where the origin lies in matter.
std::optional<SurfaceHit> first_surface(const Volume& volume, const Scene& scene, const glm::dvec3& origin,
                                        const glm::dvec3& u);

/// Always the same for the same volume, scene and size. No eye lies in matter that is seen, or within 1.5 voxels of it;
/// a camera for which there is no such place is left out.
std::vector<ReportCamera> report_cameras(const Volume& volume, const Scene& scene, int width, int height);

}  // namespace edgesplat::accuracy
