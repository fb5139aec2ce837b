// What the families that use ITK share. Internal to engine/volume: it brings ITK's headers in.
#pragma once

#include <itkImageIOBase.h>

#include <string>
#include <vector>

#include "engine/volume/load_internal.h"

namespace edgesplat::detail {

/// The type of one component; fails for types no volume has (e.g. long double).
SampleType sample_type_of(const itk::ImageIOBase& io, const std::string& path);
std::vector<std::size_t> dims_of(const itk::ImageIOBase& io);
void set_full_region(itk::ImageIOBase& io);
/// First three axes of what the IO has read: dims, direction x spacing, origin. A missing axis is 1 voxel of 1 mm.
VolumeGeometry geometry_of(const itk::ImageIOBase& io);

}  // namespace edgesplat::detail
