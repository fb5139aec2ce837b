// What a picture shows of a volume.
#pragma once

#include <glm/glm.hpp>

#include "engine/scene/camera.h"
#include "engine/volume/volume.h"

namespace edgesplat {

/// As planes of index space.
class ViewVolume {
  public:
    /// `pixels`: how far beyond the picture's sides it goes; samples lie up to half a pixel off.
    ViewVolume(const VolumeGeometry& geometry, const Camera& camera, const glm::ivec2& size, double pixels = 1);
    /// Whether a box of voxels, widened by `reach` of them, may show. Never false for one that does.
    bool shows(const glm::ivec3& low, const glm::ivec3& size, double reach) const;
    /// Whether all of it lies within. Never true for one that does not.
    bool holds(const glm::ivec3& low, const glm::ivec3& size, double reach) const;

  private:
    glm::dvec4 planes_[5];  ///< inside where dot(plane, (p, 1)) >= 0; not of unit length
};

/// How far beyond a picture's sides kernels reach that are widened by the pixel's own, which is as wide as theirs.
double pixels_of_filter(const Camera& camera, const glm::ivec2& size, double support);

}  // namespace edgesplat
