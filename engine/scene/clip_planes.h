// A scene's clip planes in a volume's index space, where kernels are cut.
#pragma once

#include <array>
#include <glm/glm.hpp>
#include <limits>
#include <optional>
#include <vector>

#include "engine/scene/effects.h"
#include "engine/volume/volume.h"

namespace edgesplat {

/// dot(normal, x) + offset is the signed distance of x in voxels; what is above 0 lies beyond the plane.
struct IndexPlane {
    glm::dvec3 normal{0, 0, 1};  ///< unit in index space
    double offset = 0;
    double distance(const glm::dvec3& x) const { return glm::dot(normal, x) + offset; }
};

/// A piece of a ray that clip planes leave. Positions along the unit direction, voxels.
struct KeptPiece {
    double first = -std::numeric_limits<double>::infinity();
    double last = std::numeric_limits<double>::infinity();
    /// Where the piece begins at a plane: the unit normal of the cut, index space, towards what is cut away.
    std::optional<glm::dvec3> face{};
    bool empty() const { return !(first < last); }
};

/// Clip in index space: kept is what no plane of `keep` has beyond it and what is beyond some plane of `remove`.
struct IndexClip {
    std::vector<IndexPlane> keep, remove;

    bool empty() const { return keep.empty() && remove.empty(); }

    /// Whether every point within `radius` voxels of x is cut away.
    bool cuts_away(const glm::dvec3& x, double radius = 0) const;

    /// The pieces of the line origin + t u (u unit) that are kept, first before and then behind what `remove` takes;
    /// either may be empty. Without planes the first is the whole line.
    std::array<KeptPiece, 2> kept_along(const glm::dvec3& origin, const glm::dvec3& u) const;
};

/// `origin` is the index-space point that positions are counted from.
IndexClip index_clip(const Clip& clip, const VolumeGeometry& geometry, const glm::dvec3& origin = glm::dvec3(0));

}  // namespace edgesplat
