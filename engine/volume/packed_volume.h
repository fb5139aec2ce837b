// Reads packed volumes: one HDF5 file with bricks at several resolutions, for volumes larger than memory
// (docs/packed_volumes.md).
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

/// Maximum number of voxels of a packed volume, along an axis and in total.
inline constexpr std::size_t kMaxPackedVoxelsPerAxis = std::size_t{1} << 20;
inline constexpr std::size_t kMaxPackedVoxels = std::size_t{1} << 40;
/// Level size for tasks that need all samples at once, e.g. suggesting iso-values.
inline constexpr std::size_t kMaxVoxelsAnalysed = std::size_t{1} << 24;

/// A volume in a file, in bricks and at several resolutions; samples are read on demand. Level 0 is the original; a
/// voxel of level n + 1 is the mean of 2 x 2 x 2 voxels of level n. Kept in memory: the value range of each brick, and
/// up to 64 MB of recently read bricks per level.
class PackedVolume {
  public:
    static constexpr int kBrick = 32;  ///< voxels along a side

    /// Reads the file's description without samples. Throws Error naming the file and the invalid field.
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
    /// Bounds of all samples in the box, from the ranges of its bricks: conservative, without disk access. The box lies
    /// inside the level and has at least one voxel.
    Range range(int level, const glm::ivec3& low, const glm::ivec3& size) const;
    /// Reads the samples of a box, x fastest, in the file's unit. The box lies inside the level; `out` has one element
    /// per voxel. Thread-safe: calls are serialised. Throws Error if the file is damaged.
    void read(int level, const glm::ivec3& low, const glm::ivec3& size, std::span<float> out) const;

    const std::string& path() const;
    const std::string& sample_type() const;  ///< as stored: uint8, int16, uint16 or float32
    const std::string& source() const;       ///< name of the volume that was packed
    double mean() const;                     ///< of level 0
    /// Largest difference from the original samples; 0 unless quantised.
    double quantisation_error() const;
    /// Counts of all level-0 samples in the file's bins.
    const Histogram& histogram() const;
    /// Number of level-0 samples with data of each of the description's labels, if it has any.
    const std::vector<std::uint64_t>& label_voxels() const;
    /// The volume's description, without `packed`.
    const Volume& description() const;

  private:
    struct State;
    explicit PackedVolume(std::unique_ptr<State> state);
    std::unique_ptr<State> state_;
};

/// Opens the file as a volume without samples in memory: `packed` is set; everything else is as in the original.
Volume open_packed(const std::string& path);

/// Loads a whole level into memory: an ordinary, finished volume with the level's geometry; level 0 with its labels.
/// Throws Error if the level does not exist or has more than `kMaxVoxels`, or if a sample is none of the labels.
Volume load_level(const Volume& packed, int level);

/// The volume with its samples in memory if it is a packed segmentation of at most `kMaxVoxelsAnalysed` voxels; else
/// the volume.
Volume small_labels_in_memory(Volume volume);

/// The finest level of at most `voxels` voxels; the coarsest level if there is none.
int finest_level_within(const PackedVolume& packed, std::size_t voxels);

/// The sample of a voxel, in the file's unit, read from memory or from the file.
float value_at(const Volume& volume, const glm::ivec3& voxel);

/// Fails for a packed volume; the message says that `what` needs all samples in memory.
void require_samples(const Volume& volume, std::string_view what);

}  // namespace edgesplat
