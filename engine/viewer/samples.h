// Samples and interpolated values of a volume, in memory or in a packed file.
#pragma once

#include <array>
#include <glm/glm.hpp>
#include <limits>
#include <vector>

#include "engine/volume/packed_volume.h"
#include "engine/volume/volume.h"

namespace edgesplat::viewer {

/// Reads the full resolution. For a packed volume it caches one box of voxels, so that neighbouring reads need one file
/// access. Not thread-safe: use one reader per thread. The volume must outlive it.
class Samples {
  public:
    explicit Samples(const Volume& volume) : volume_(volume) {}

    const Volume& volume() const { return volume_; }
    /// The sample of the voxel nearest to i; i is clamped to the volume.
    double at(const glm::ivec3& i) const;
    /// Trilinear value at a position in index space, clamped to the range of voxel centres.
    double linear(const glm::dvec3& voxel) const;
    /// The eight samples of the cell with the lowest corner `cell`; bit k of the index is the step along axis k.
    std::array<double, 8> corners(const glm::ivec3& cell) const;
    /// Central differences of `linear` at distance 1 voxel, one-sided at the border; per voxel along each axis.
    glm::dvec3 gradient(const glm::dvec3& voxel) const;

  private:
    const Volume& volume_;
    mutable std::vector<float> box_;  ///< cached box of a packed volume
    mutable glm::ivec3 box_low_{std::numeric_limits<int>::max() / 2};
    mutable glm::ivec3 box_size_{0};
};

/// One trilinear value at a position in index space. For many values, keep a Samples.
double interpolated(const Volume& volume, const glm::dvec3& voxel);

}  // namespace edgesplat::viewer
