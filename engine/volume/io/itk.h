// Helpers of the readers that use ITK. Internal to engine/volume: it includes ITK's headers.
#pragma once

#include <itkImageIOBase.h>

#include <string>
#include <vector>

#include "engine/volume/io/readers.h"

namespace edgesplat::detail {

/// The type of one component; fails for unsupported types (e.g. long double).
SampleType sample_type_of(const itk::ImageIOBase& io, const std::string& path);
std::vector<std::size_t> dims_of(const itk::ImageIOBase& io);
void set_full_region(itk::ImageIOBase& io);
/// Geometry of the first three axes: dims, direction x spacing, origin. A missing axis is 1 voxel of 1 mm.
VolumeGeometry geometry_of(const itk::ImageIOBase& io);

}  // namespace edgesplat::detail
