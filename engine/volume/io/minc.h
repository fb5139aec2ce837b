// The parts of a MINC file that define a volume, from MINC1 (netCDF) or MINC2 (HDF5). Internal to engine/volume/io.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "engine/files/sample_type_internal.h"
#include "engine/volume/io/classic_netcdf.h"

namespace edgesplat::detail {

struct MincDimension {
    std::string name;
    std::size_t length = 0;
    VariableAttributes attributes;
};

struct MincImage {
    std::vector<MincDimension> dimensions;  ///< slowest first
    SampleType type = SampleType::UInt8;
    bool swapped = false;
    std::vector<double> valid_range;  ///< two stored values; empty: those of the type
    /// image-min and image-max: real values of the valid range's ends, for each index of the first dimensions.
    std::vector<double> low, high;
    std::function<std::vector<char>()> read;  ///< all samples
};

MincImage minc1_image(const std::string& path);
MincImage minc2_image(const std::string& path);

}  // namespace edgesplat::detail
