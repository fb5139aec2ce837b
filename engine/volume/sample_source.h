// A volume at one of its resolutions, read box by box: what is drawn need not be in memory whole.
#pragma once

#include <memory>
#include <span>

#include "engine/volume/volume.h"

namespace edgesplat {

/// Bounds of some samples.
struct ValueRange {
    float low = 0, high = 0;
};

/// Samples of one resolution of a volume. Thread-safe.
class SampleSource {
  public:
    virtual ~SampleSource() = default;
    virtual const VolumeGeometry& geometry() const = 0;
    /// Bounds of the samples of a box that lies in the volume; may be wider than they are.
    virtual ValueRange range(const glm::ivec3& low, const glm::ivec3& size) const = 0;
    /// The samples of a box that lies in the volume, x fastest, in the file's unit.
    virtual void read(const glm::ivec3& low, const glm::ivec3& size, std::span<float> out) const = 0;
};

/// Samples in memory, or in a packed file at `level`. An owner of samples in memory has level 0 only.
std::shared_ptr<const SampleSource> source_of(std::shared_ptr<const Volume> volume, int level);

/// Means of 2 x 2 x 2 voxels (of those there are at odd ends). Range, name and notes stay those of `volume`, so that
/// iso-values keep their meaning.
Volume halved(const Volume& volume);

/// Resolutions of a volume, each half as fine as the one before: as many as its file has, or until no axis is longer
/// than 64 voxels. At least 1.
int level_count(const Volume& volume);

/// Geometry of a level: boxes of 2^level voxels along each axis, placed where their centres are.
VolumeGeometry level_geometry(const VolumeGeometry& geometry, int level);

}  // namespace edgesplat
