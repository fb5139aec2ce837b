// What a picture shows of a volume.
#pragma once

#include <glm/glm.hpp>

#include "engine/scene/camera.h"
#include "engine/volume/volume.h"

namespace edgesplat {

/// As planes of index space.
class ViewVolume {
  public:
    /// It goes a pixel beyond the picture's sides, since samples lie up to half a pixel off; with `antialias` as far as
    /// kernels reach that are widened by the pixel's own.
    ViewVolume(const VolumeGeometry& geometry, const Camera& camera, const glm::ivec2& size, bool antialias = false);
    /// Whether a box of voxels, widened by `reach` of them, may show. Never false for one that does.
    bool shows(const glm::ivec3& low, const glm::ivec3& size, double reach) const;
    /// Whether all of it lies within. Never true for one that does not.
    bool holds(const glm::ivec3& low, const glm::ivec3& size, double reach) const;

  private:
    glm::dvec4 planes_[5];  ///< inside where dot(plane, (p, 1)) >= 0; not of unit length
};

}  // namespace edgesplat
