// Finds paths along the middle of cavities.
#pragma once

#include <glm/glm.hpp>
#include <optional>
#include <vector>

#include "engine/scene/camera.h"
#include "engine/scene/camera_path.h"
#include "engine/viewer/walls.h"

namespace edgesplat::viewer {

/// Centre line between two points of a cavity.
struct GuidedPath {
    std::vector<glm::dvec3> points;  ///< world mm, at least 2, evenly spaced about one voxel apart, all outside matter
    std::vector<double> room;        ///< mm to the wall at each point
    double length = 0;               ///< mm along the points
    /// The point at a length, mm; extrapolated straight beyond both ends.
    glm::dvec3 at(double millimetres) const;
};

/// The shortest path over the free voxels of the walls' grid (26 neighbours), smoothed. Lengths are weighted by 1 /
/// room^2, with room limited to 16 voxels. Ends inside matter move to the nearest free voxel within 5 voxels. An end
/// outside the volume is connected straight to the nearest voxel. nullopt if the ends are not connected, not finite,
/// more than 5 voxels inside matter, or at the same place.
std::optional<GuidedPath> guided_path(const Walls& walls, const glm::dvec3& from, const glm::dvec3& to);

/// The camera path at constant speed, looking ahead; at most 256 keys. Throws Error as validate(CameraPath) does, and
/// unless seconds > 0.
CameraPath camera_path_along(const GuidedPath& path, double seconds, double fov, const glm::dvec3& up);

/// The camera at a length of that path (clamped to the path); place, view and up are continuous.
Camera camera_along(const GuidedPath& path, double millimetres, double fov, const glm::dvec3& up);

}  // namespace edgesplat::viewer
