// Values of a volume between its voxels, in memory or in a packed file.
#pragma once

#include <array>
#include <glm/glm.hpp>
#include <limits>
#include <vector>

#include "engine/volume/packed_volume.h"
#include "engine/volume/volume.h"

namespace edgesplat::viewer {

/// Reads the full resolution; of a packed volume a box of voxels at a time is held, so that neighbouring reads cost one
/// access to the file. Not thread-safe: one reader a thread. The volume must outlive it.
class Samples {
  public:
    explicit Samples(const Volume& volume) : volume_(volume) {}

    const Volume& volume() const { return volume_; }
    /// The sample of the voxel nearest to i in the volume.
    double at(const glm::ivec3& i) const;
    /// Trilinear; positions outside the voxels' centres have the value of the nearest point between them.
    double linear(const glm::dvec3& voxel) const;
    /// The eight samples around the cell whose lowest corner is `cell`; bit k of the place is the step along axis k.
    std::array<double, 8> corners(const glm::ivec3& cell) const;
    /// Central differences of `linear` at distance 1 voxel; per voxel along each axis.
    glm::dvec3 gradient(const glm::dvec3& voxel) const;

  private:
    const Volume& volume_;
    mutable std::vector<float> box_;  ///< of a packed volume
    mutable glm::ivec3 box_low_{std::numeric_limits<int>::max() / 2};
    mutable glm::ivec3 box_size_{0};
};

/// One value, trilinear, at a position in index space. For many, keep a Samples.
double interpolated(const Volume& volume, const glm::dvec3& voxel);

}  // namespace edgesplat::viewer
