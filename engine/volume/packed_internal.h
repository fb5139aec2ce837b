// Layout of a packed volume's file, shared by its writer and reader. Internal to engine/volume.
#pragma once

#include "engine/volume/io/hdf5.h"
#include "engine/volume/packed_volume.h"

namespace edgesplat::detail {

inline constexpr const char* kPackedFormat = "edgesplat packed volume";
inline constexpr std::uint64_t kPackedVersion = 1;
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
/// Index of the bin that contains a value, as in `histogram`.
std::size_t bin_of(float value, double low, double scale, std::size_t bins);

}  // namespace edgesplat::detail
