// Tests whether a box of voxels is in a picture's view.
#pragma once

#include <glm/glm.hpp>

#include "engine/scene/camera.h"
#include "engine/volume/volume.h"

namespace edgesplat {

/// The part of space that a picture shows, as planes of index space.
class ViewVolume {
  public:
    /// Widened by a pixel beyond the picture's sides, since samples lie up to half a pixel off; with `antialias` also
    /// by the reach of kernels that are widened by the pixel's kernel.
    ViewVolume(const VolumeGeometry& geometry, const Camera& camera, const glm::ivec2& size, bool antialias = false);
    /// Whether a box of voxels, widened by `reach` voxels, may be visible. Never false if it is.
    bool shows(const glm::ivec3& low, const glm::ivec3& size, double reach) const;
    /// Whether the widened box lies inside completely. Never true if it does not.
    bool holds(const glm::ivec3& low, const glm::ivec3& size, double reach) const;

  private:
    glm::dvec4 planes_[5];  ///< inside: dot(plane, (p, 1)) >= 0; not normalised
};

}  // namespace edgesplat
