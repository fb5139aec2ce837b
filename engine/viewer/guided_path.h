// Ways through cavities that keep to the middle.
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
    std::vector<glm::dvec3> points;  ///< world mm, at least 2, evenly spaced, about one voxel apart, all outside matter
    std::vector<double> room;        ///< mm to the wall at each
    double length = 0;               ///< mm along the points
    /// The point at a length, mm; straight on beyond both ends.
    glm::dvec3 at(double millimetres) const;
};

/// Shortest way over the free voxels of the walls' grid (26 neighbours), lengths weighted by 1 / room^2 up to a room of
/// 16 voxels, smoothed. Ends inside matter move to the nearest free voxel within 5 voxels. None where the ends are not
/// connected, not finite, more than 5 voxels inside matter, or at the same place. A point outside the volume goes
/// straight to the nearest voxel of it.
std::optional<GuidedPath> guided_path(const Walls& walls, const glm::dvec3& from, const glm::dvec3& to);

/// At constant speed along the path, looking ahead; at most 256 keys. Throws Error as validate(CameraPath) does, and
/// unless seconds > 0.
CameraPath camera_path_along(const GuidedPath& path, double seconds, double fov, const glm::dvec3& up);

/// The camera of that path when the eye has gone so far (clamped to the path); continuous in place, view and up.
Camera camera_along(const GuidedPath& path, double millimetres, double fov, const glm::dvec3& up);

}  // namespace edgesplat::viewer
