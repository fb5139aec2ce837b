// Volumes larger than memory: one HDF5 file, in bricks and at several resolutions (docs/packed_volumes.md).
#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "engine/volume/filters.h"
#include "engine/volume/volume.h"

namespace edgesplat {

/// Voxels a packed volume may have, along an axis and in all.
inline constexpr std::size_t kMaxPackedVoxelsPerAxis = std::size_t{1} << 20;
inline constexpr std::size_t kMaxPackedVoxels = std::size_t{1} << 40;
/// What `load_level` takes where all samples must be looked at once, to suggest iso-values for example.
inline constexpr std::size_t kMaxVoxelsLookedAt = std::size_t{1} << 24;

/// A volume in a file, in bricks and at several resolutions; samples are read when asked for. Level 0 is the volume
/// itself; a voxel of level n + 1 is the mean of 2 x 2 x 2 of level n. Held in memory: the range of each brick, and up
/// to 64 MB of the bricks last read of each level.
class PackedVolume {
  public:
    static constexpr int kBrick = 32;  ///< voxels along a side

    /// Reads what the file says of itself, and no samples. Throws Error naming the file and the field that is wrong.
    static std::shared_ptr<const PackedVolume> open(const std::string& path);

    PackedVolume(const PackedVolume&) = delete;
    PackedVolume& operator=(const PackedVolume&) = delete;
    ~PackedVolume();

    int levels() const;  ///< >= 1
    const VolumeGeometry& geometry(int level) const;
    /// Bounds of samples, in the file's unit.
    struct Range {
        float low = 0, high = 0;
    };
    /// Bounds of all samples in the box, from the bricks it touches: conservative, without disk access. The box lies
    /// inside the level and has at least a voxel.
    Range range(int level, const glm::ivec3& low, const glm::ivec3& size) const;
    /// Samples of a box, x fastest, in the file's unit; the box lies inside the level, `out` has one place a voxel.
    /// May be called from several threads, which wait for each other. Throws Error where the file is damaged.
    void read(int level, const glm::ivec3& low, const glm::ivec3& size, std::span<float> out) const;

    const std::string& path() const;
    const std::string& sample_type() const;  ///< as stored: uint8, int16, uint16 or float32
    const std::string& source() const;       ///< name of the volume that was packed
    double mean() const;                     ///< of level 0
    /// Largest difference from the volume that was packed; 0 unless it was quantised.
    double quantisation_error() const;
    /// Counts of all samples of level 0, in the bins of the file.
    const Histogram& histogram() const;
    /// What the volume says of itself, without `packed`.
    const Volume& description() const;

  private:
    struct State;
    explicit PackedVolume(std::unique_ptr<State> state);
    std::unique_ptr<State> state_;
};

/// Opens it as a volume without samples in memory: `packed` is set, all else is as it was when it was packed.
Volume open_packed(const std::string& path);

/// A whole level of a packed volume in memory: an ordinary, finished volume with the level's geometry. Throws Error
/// where there is no such level or it has more than `kMaxVoxels`.
Volume load_level(const Volume& packed, int level);

/// The finest level of at most so many voxels; the coarsest where none is.
int finest_level_within(const PackedVolume& packed, std::size_t voxels);

/// The sample of a voxel, in the file's unit, from memory or from the file.
float value_at(const Volume& volume, const glm::ivec3& voxel);

/// Fails for a packed volume: `what` needs all samples in memory.
void need_samples(const Volume& volume, std::string_view what);

}  // namespace edgesplat
