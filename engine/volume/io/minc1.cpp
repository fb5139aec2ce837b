// MINC1 files: netCDF in its classic format, big-endian.
#include <algorithm>

#include "engine/volume/io/binary_file.h"
#include "engine/volume/io/classic_netcdf.h"
#include "engine/volume/io/minc.h"

namespace edgesplat::detail {
namespace {

SampleType minc1_type(const std::string& path, const ClassicNetcdf::Variable& variable) {
    const auto found = variable.attributes.texts.find("signtype");
    const std::string sign = found == variable.attributes.texts.end() ? "" : found->second;
    const bool is_unsigned = sign.starts_with("unsigned") || (!sign.starts_with("signed") && variable.type == 1);
    switch (variable.type) {
        case 1:
            return is_unsigned ? SampleType::UInt8 : SampleType::Int8;
        case 3:
            return is_unsigned ? SampleType::UInt16 : SampleType::Int16;
        case 4:
            return is_unsigned ? SampleType::UInt32 : SampleType::Int32;
        case 5:
            return SampleType::Float32;
        case 6:
            return SampleType::Float64;
        default:
            fail("{}: its image has the netCDF type {}, expected numbers", path, variable.type);
    }
}

}  // namespace

MincImage minc1_image(const std::string& path) {
    const ClassicNetcdf file = read_classic_netcdf(path);
    const auto entries = [&](const ClassicNetcdf::Variable& variable) {
        std::size_t count = 1;
        for (const std::size_t id : variable.dimensions) {
            const std::size_t length = file.dimensions[id].length;
            if (length == 0)
                fail("{}: its dimension {} is unlimited or empty, expected a fixed length", path,
                     tidy(file.dimensions[id].name));
            if (__builtin_mul_overflow(count, length, &count) || count > std::size_t{1} << 40)
                fail("{}: more than 2^40 samples", path);
        }
        return count;
    };
    const auto found = file.variables.find("image");
    if (found == file.variables.end()) fail("{}: a netCDF file without the variable image: not MINC", path);
    const ClassicNetcdf::Variable& variable = found->second;
    const bool swapped = std::endian::native == std::endian::little;

    MincImage image;
    image.type = minc1_type(path, variable);
    image.swapped = swapped;
    for (const std::size_t id : variable.dimensions) {
        MincDimension dimension{file.dimensions[id].name, file.dimensions[id].length, {}};
        if (const auto own = file.variables.find(dimension.name); own != file.variables.end())
            dimension.attributes = own->second.attributes;
        image.dimensions.push_back(std::move(dimension));
    }
    if (const auto range = variable.attributes.numbers.find("valid_range");
        range != variable.attributes.numbers.end() && range->second.size() == 2)
        image.valid_range = range->second;
    const auto end_values = [&](const char* name) {
        std::vector<double> values;
        const auto place = file.variables.find(name);
        if (place == file.variables.end()) return values;
        const ClassicNetcdf::Variable& ends = place->second;
        if (ends.dimensions.size() > variable.dimensions.size() ||
            !std::equal(ends.dimensions.begin(), ends.dimensions.end(), variable.dimensions.begin()))
            fail("{}: the dimensions of {} are not the first ones of image", path, name);
        if (ends.type != 5 && ends.type != 6)
            fail("{}: {} has the netCDF type {}, expected 5 or 6", path, name, ends.type);
        const std::size_t count = entries(ends), size = ClassicNetcdf::size_of(ends.type);
        check_memory(path, name, count * (size + sizeof(double)));
        std::vector<std::string> ignored;
        BinaryHeader data{{}, swapped};
        const auto bytes =
            read_block({.path = path, .file = path, .offset = ends.begin, .bytes = count * size}, {}, ignored);
        data.bytes.assign(bytes.begin(), bytes.end());
        for (std::size_t at = 0; at < data.bytes.size(); at += size)
            values.push_back(size == 4 ? static_cast<double>(data.get<float>(at)) : data.get<double>(at));
        return values;
    };
    image.low = end_values("image-min");
    image.high = end_values("image-max");
    image.read = [path, begin = variable.begin, bytes = entries(variable) * size_of(image.type)] {
        std::vector<std::string> ignored;  // other variables may follow
        return read_block({.path = path, .file = path, .offset = begin, .bytes = bytes}, {}, ignored);
    };
    return image;
}

}  // namespace edgesplat::detail
