// The header of MINC2 files: HDF5.
#include <hdf5.h>

#include "engine/volume/io/binary_file.h"
#include "engine/volume/io/hdf5.h"
#include "engine/volume/io/minc.h"

namespace edgesplat::detail {
namespace {

/// Holds the HDF5 lock; HDF5 prints no errors meanwhile.
class Minc2Lock {
  public:
    Minc2Lock() : lock_(hdf5_mutex()) {
        H5Eget_auto2(H5E_DEFAULT, &print_, &data_);
        H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
    }
    ~Minc2Lock() { H5Eset_auto2(H5E_DEFAULT, print_, data_); }
    Minc2Lock(const Minc2Lock&) = delete;
    Minc2Lock& operator=(const Minc2Lock&) = delete;

  private:
    std::lock_guard<std::recursive_mutex> lock_;
    H5E_auto2_t print_ = nullptr;
    void* data_ = nullptr;
};

std::vector<std::size_t> minc2_extent(hid_t data_space) {
    const int axes = H5Sget_simple_extent_ndims(data_space);
    std::vector<hsize_t> sizes(static_cast<std::size_t>(std::max(axes, 0)));
    if (axes > 0) H5Sget_simple_extent_dims(data_space, sizes.data(), nullptr);
    return {sizes.begin(), sizes.end()};
}

/// The text of an attribute; fixed or variable length.
std::string minc2_text(hid_t attribute, hid_t type) {
    std::string text;
    if (H5Tis_variable_str(type) > 0) {
        char* data = nullptr;
        const Hdf5Id memory(H5Tcopy(type), H5Tclose);
        if (H5Aread(attribute, memory.get(), &data) >= 0 && data != nullptr) {
            text = data;
            H5free_memory(data);
        }
        return text;
    }
    text.resize(std::min<std::size_t>(H5Tget_size(type), 1 << 16));
    if (H5Tget_size(type) > text.size() || H5Aread(attribute, type, text.data()) < 0) return "";
    return text.substr(0, text.find('\0'));
}

VariableAttributes minc2_attributes(hid_t object) {
    VariableAttributes result;
    for (const char* name :
         {"step", "start", "direction_cosines", "length", "valid_range", "units", "spacing", "alignment", "dimorder"}) {
        if (H5Aexists(object, name) <= 0) continue;
        const Hdf5Id attribute(H5Aopen(object, name, H5P_DEFAULT), H5Aclose);
        if (!attribute) continue;
        const Hdf5Id type(H5Aget_type(attribute.get()), H5Tclose), data_space(H5Aget_space(attribute.get()), H5Sclose);
        const H5T_class_t kind = H5Tget_class(type.get());
        const hssize_t count = H5Sget_simple_extent_npoints(data_space.get());
        if (kind == H5T_STRING && count == 1) {
            result.texts[name] = trimmed(minc2_text(attribute.get(), type.get()));
        } else if ((kind == H5T_INTEGER || kind == H5T_FLOAT) && count >= 1 && count <= 16) {
            std::vector<double> numbers(static_cast<std::size_t>(count));
            if (H5Aread(attribute.get(), H5T_NATIVE_DOUBLE, numbers.data()) >= 0) result.numbers[name] = numbers;
        }
    }
    return result;
}

SampleType minc2_type(const std::string& path, hid_t type) {
    const H5T_class_t kind = H5Tget_class(type);
    SampleType result = SampleType::UInt8;
    const char* name = kind == H5T_FLOAT ? "float" : H5Tget_sign(type) == H5T_SGN_2 ? "int" : "uint";
    if ((kind != H5T_FLOAT && kind != H5T_INTEGER) ||
        !sample_type_named(fmt::format("{}{}", name, 8 * H5Tget_size(type)), result))
        fail("{}: its image has samples of a type that is not read; expected integers or floats", path);
    return result;
}

std::vector<std::string> words_between_commas(const std::string& text) {
    std::vector<std::string> words;
    for (std::size_t begin = 0; begin <= text.size();) {
        const auto end = std::min(text.find(',', begin), text.size());
        words.push_back(trimmed(text.substr(begin, end - begin)));
        begin = end + 1;
    }
    return words;
}

constexpr const char* kMinc2Image = "/minc-2.0/image/0/image";

}  // namespace

MincImage minc2_image(const std::string& path) {
    const Minc2Lock lock;
    const Hdf5Id access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
#if H5_VERSION_GE(1, 10, 7)
    H5Pset_file_locking(access.get(), false, true);
#endif
    const Hdf5Id file(H5Fopen(path.c_str(), H5F_ACC_RDONLY, access.get()), H5Fclose);
    if (!file) fail("{}: cannot be opened, it is truncated or damaged", path);
    const Hdf5Id dataset(H5Dopen2(file.get(), kMinc2Image, H5P_DEFAULT), H5Dclose);
    if (!dataset) fail("{}: an HDF5 file without {}: not MINC2", path, kMinc2Image);
    const Hdf5Id type(H5Dget_type(dataset.get()), H5Tclose), data_space(H5Dget_space(dataset.get()), H5Sclose);
    const auto extent = minc2_extent(data_space.get());
    const VariableAttributes own = minc2_attributes(dataset.get());

    MincImage image;
    image.type = minc2_type(path, type.get());
    const auto order = own.texts.find("dimorder");
    if (order == own.texts.end()) fail("{}: {} has no attribute dimorder", path, kMinc2Image);
    const auto names = words_between_commas(order->second);
    if (names.size() != extent.size())
        fail("{}: dimorder '{}' names {} dimensions, the image has {}", path, tidy(order->second), names.size(),
             extent.size());
    for (std::size_t axis = 0; axis < extent.size(); ++axis) {
        MincDimension dimension{.name = names[axis], .length = extent[axis], .attributes = {}};
        const std::string place = "/minc-2.0/dimensions/" + names[axis];
        const Hdf5Id described(names[axis].empty() ? -1 : H5Oopen(file.get(), place.c_str(), H5P_DEFAULT), H5Oclose);
        if (described) dimension.attributes = minc2_attributes(described.get());
        image.dimensions.push_back(std::move(dimension));
    }
    if (const auto range = own.numbers.find("valid_range"); range != own.numbers.end() && range->second.size() == 2)
        image.valid_range = range->second;
    const auto end_values = [&](const char* name) {
        std::vector<double> values;
        const std::string place = fmt::format("/minc-2.0/image/0/{}", name);
        const Hdf5Id ends(H5Dopen2(file.get(), place.c_str(), H5P_DEFAULT), H5Dclose);
        if (!ends) return values;
        const Hdf5Id ends_space(H5Dget_space(ends.get()), H5Sclose);
        const auto sizes = minc2_extent(ends_space.get());
        if (sizes.size() > extent.size() || !std::equal(sizes.begin(), sizes.end(), extent.begin()))
            fail("{}: the dimensions of {} are not the first ones of image", path, name);
        std::size_t count = 1;
        for (const std::size_t size : sizes)
            if (__builtin_mul_overflow(count, size, &count) || count > std::size_t{1} << 31)
                fail("{}: {} has more than 2^31 entries", path, name);
        check_memory(path, name, count * sizeof(double));
        check_stored_size(path, count * 4, std::filesystem::file_size(path));
        values.resize(count);
        if (H5Dread(ends.get(), H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()) < 0)
            fail("{}: {} cannot be read, the file is damaged", path, name);
        return values;
    };
    image.low = end_values("image-min");
    image.high = end_values("image-max");
    image.read = [path, extent, sample = image.type] {
        const Hdf5Dataset samples = Hdf5File::open(path).dataset(kMinc2Image);
        std::size_t bytes = size_of(sample);
        for (const std::size_t size : extent)
            bytes *= size;
        std::vector<char> data(bytes);
        samples.read(Hdf5Extent(extent.size(), 0), {extent.begin(), extent.end()}, sample, data.data());
        return data;
    };
    return image;
}

}  // namespace edgesplat::detail
