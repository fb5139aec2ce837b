// Clip planes of a scene in the volume's index space, where kernels are cut.
#pragma once

#include <array>
#include <glm/glm.hpp>
#include <limits>
#include <optional>
#include <vector>

#include "engine/scene/effects.h"
#include "engine/volume/volume.h"

namespace edgesplat {

/// dot(normal, x) + offset is the signed distance of x in voxels; points with distance > 0 are beyond the plane.
struct IndexPlane {
    glm::dvec3 normal{0, 0, 1};  ///< unit in index space
    double offset = 0;
    double distance(const glm::dvec3& x) const { return glm::dot(normal, x) + offset; }
};

/// An interval of a ray that clip planes keep. Positions along the unit direction, voxels.
struct KeptPiece {
    double first = -std::numeric_limits<double>::infinity();
    double last = std::numeric_limits<double>::infinity();
    /// If the interval begins at a plane: the unit normal of the cut, index space, towards the removed side.
    std::optional<glm::dvec3> face{};
    bool empty() const { return !(first < last); }
};

/// Clip planes in index space. A point is kept if it is beyond no plane of `keep`, and `remove` is empty or the point
/// is beyond some plane of `remove`.
struct IndexClip {
    std::vector<IndexPlane> keep, remove;

    bool empty() const { return keep.empty() && remove.empty(); }

    /// Whether all points within `radius` voxels of x are removed.
    bool cuts_away(const glm::dvec3& x, double radius = 0) const;

    /// The kept intervals of the line origin + t u (u unit): before and behind the region of `remove`; either may be
    /// empty. Without planes the first is the whole line.
    std::array<KeptPiece, 2> kept_along(const glm::dvec3& origin, const glm::dvec3& u) const;
};

/// Converts a scene's clip planes. `origin` is the index-space point from which positions are measured.
IndexClip index_clip(const Clip& clip, const VolumeGeometry& geometry, const glm::dvec3& origin = glm::dvec3(0));

}  // namespace edgesplat
