// Reads one resolution of a volume box by box, so that the whole volume need not be in memory.
#pragma once

#include <memory>
#include <span>

#include "engine/volume/volume.h"

namespace edgesplat {

/// Bounds of a set of samples.
struct ValueRange {
    float low = 0, high = 0;
    bool complete = true;  ///< false: some samples contain no data
};

/// Samples of one resolution of a volume. Thread-safe.
class SampleSource {
  public:
    virtual ~SampleSource() = default;
    virtual const VolumeGeometry& geometry() const = 0;
    /// Bounds of the samples of a box inside the volume; may be conservative.
    virtual ValueRange range(const glm::ivec3& low, const glm::ivec3& size) const = 0;
    /// Reads the samples of a box inside the volume, x fastest, in the volume's unit; NaN without data.
    virtual void read(const glm::ivec3& low, const glm::ivec3& size, std::span<float> out) const = 0;
};

/// The samples of a level, from memory or from a packed file. A volume in memory has level 0 only.
std::shared_ptr<const SampleSource> source_of(std::shared_ptr<const Volume> volume, int level);

/// Averages 2 x 2 x 2 voxels (fewer at odd ends); without data if more than half of them are. Range, name and notes of
/// `volume` are kept, so that iso-values keep their meaning.
Volume halved(const Volume& volume);

/// Number of levels, each with half the resolution of the previous: those in the file, or until no axis is longer than
/// 64 voxels. At least 1.
int level_count(const Volume& volume);

/// Geometry of a level: each voxel covers 2^level voxels along each axis and lies at their centre.
VolumeGeometry level_geometry(const VolumeGeometry& geometry, int level);

}  // namespace edgesplat
