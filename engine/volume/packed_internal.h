// Layout of a packed volume's file, shared by its writer and reader. Internal to engine/volume.
#pragma once

#include "engine/volume/io/hdf5.h"
#include "engine/volume/packed_volume.h"

namespace edgesplat::detail {

inline constexpr const char* kPackedFormat = "edgesplat packed volume";
/// Version 1 has no labels, `geometry_source`, `length_unit` and `warnings`.
inline constexpr std::uint64_t kPackedVersion = 2;
inline constexpr std::uint64_t kPackedBins = 4096;
/// Levels are added until no axis has more voxels.
inline constexpr int kCoarsestSide = 64;

/// (x, y, z) in the axis order of HDF5.
Hdf5Extent extent_of(const glm::ivec3& v);
/// Bricks along each axis.
glm::ivec3 bricks_of(const glm::ivec3& dims);
/// "/levels/LEVEL/NAME"
std::string level_path(int level, std::string_view name);
/// The geometry of every level of a volume.
std::vector<VolumeGeometry> level_geometries(const VolumeGeometry& finest);
/// Fails if a dataset has another extent than `wanted`.
void check_extent(const std::string& path, const std::string& name, const Hdf5Extent& found, const Hdf5Extent& wanted);

/// Writes the datasets of labels. `voxels`: number of samples with data of each.
void write_labels(Hdf5File& file, const LabelTable& table, const std::vector<std::uint64_t>& voxels);
/// Place in the table of a sample. Fails if it is none of the labels.
std::size_t checked_place(const LabelTable& table, float sample, const std::string& name);
struct PackedLabels {
    std::shared_ptr<const LabelTable> table;  ///< null: the volume has no labels
    std::vector<std::uint64_t> voxels;
};
/// Reads `count` labels. `with_data`: number of samples with data. Throws Error if they contradict each other.
PackedLabels read_labels(const Hdf5File& file, const std::string& path, std::uint64_t count, std::uint64_t with_data);

/// Index of the bin that contains a value, as in `histogram`.
std::size_t bin_of(float value, double low, double scale, std::size_t bins);

}  // namespace edgesplat::detail
