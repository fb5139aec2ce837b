// Packed volumes: the input changes attributes and datasets of a small valid file through HDF5. Files that are not HDF5
// are not fuzzed here.
#include <array>
#include <cmath>
#include <cstring>
#include <filesystem>

#include "engine/error.h"
#include "engine/volume/packed_internal.h"
#include "tests/fuzz/fuzz_file.h"

using namespace edgesplat;
using namespace edgesplat::detail;

namespace {

class Input {
  public:
    Input(const std::uint8_t* data, std::size_t size) : data_(data), left_(size) {}
    std::uint8_t byte() {
        if (left_ == 0) return 0;
        --left_;
        return *data_++;
    }
    double number() {
        double value = 0;
        std::array<std::uint8_t, sizeof value> raw{};
        for (std::uint8_t& part : raw)
            part = byte();
        std::memcpy(&value, raw.data(), sizeof value);
        return value;
    }
    std::string text() {
        std::string result(byte() % 32, '\0');
        for (char& c : result)
            c = static_cast<char>(byte());
        return result;
    }

  private:
    const std::uint8_t* data_;
    std::size_t left_;
};

// `how` 0: valid; otherwise it selects what is wrong with the attribute.
void put_numbers(Hdf5File& file, Input& in, const char* name, std::vector<double> values) {
    const std::uint8_t how = in.byte();
    if (how == 1) return;
    if (how == 2) return file.set_text(name, in.text());
    if (how == 3) values[in.byte() % values.size()] = in.number();
    if (how == 4) values.resize(1 + in.byte() % 16);
    const SampleType type = how == 5 ? static_cast<SampleType>(in.byte() % 10) : SampleType::Float64;
    file.set_numbers(name, type, values.size() == 1 ? Hdf5Extent{} : Hdf5Extent{values.size()}, values.data());
}

void put_whole(Hdf5File& file, Input& in, const char* name, std::uint64_t value) {
    const std::uint8_t how = in.byte();
    if (how == 1) return;
    if (how == 2) return file.set_text(name, in.text());
    if (how == 3) return file.set_number(name, SampleType::Float64, in.number());
    file.set_whole_number(name, how == 4 ? in.byte() : value);
}

void put_text(Hdf5File& file, Input& in, const char* name, const std::string& value) {
    const std::uint8_t how = in.byte();
    if (how == 1) return;
    if (how == 2) return file.set_number(name, SampleType::Float64, in.number());
    file.set_text(name, how == 3 ? in.text() : value);
}

void put_dataset(Hdf5File& file, Input& in, const std::string& path, Hdf5Extent extent, SampleType type,
                 std::uint64_t first) {
    const std::uint8_t how = in.byte();
    if (how == 1) return;
    if (how == 2) extent[in.byte() % extent.size()] += in.byte();
    if (how == 3) extent.push_back(1 + in.byte() % 4);
    if (how == 4) type = static_cast<SampleType>(in.byte() % 10);
    // A large dataset without data.
    if (how == 5) extent[in.byte() % extent.size()] <<= in.byte() % 40;
    const auto dataset = file.create_dataset(path, {.type = type, .extent = extent, .chunk = how == 5 ? 32U : 0U});
    if (how == 5 || how == 6) return;
    std::size_t count = 1;
    for (const std::uint64_t n : extent)
        count *= n;
    if (count > 1 << 20) return;
    std::vector<double> values(count, 0.0);
    values[0] = how == 7 ? in.number() : static_cast<double>(first);
    dataset.write(Hdf5Extent(extent.size(), 0), extent, SampleType::Float64, values.data());
}

void make(const std::string& path, Input& in) {
    auto file = Hdf5File::create(path, path);
    put_text(file, in, "format", kPackedFormat);
    put_whole(file, in, "version", kPackedVersion);
    put_numbers(file, in, "dims", {3, 2, 2});
    put_numbers(file, in, "index_to_world_axes", {1, 0, 0, 0, 1, 0, 0, 0, 1});
    put_numbers(file, in, "origin", {0, 0, 0});
    put_whole(file, in, "in_patient", 0);
    for (const char* name : {"min", "max", "intercept", "mean", "quantisation_error"})
        put_numbers(file, in, name, {0});
    put_numbers(file, in, "slope", {1});
    put_whole(file, in, "non_finite_count", 0);
    put_whole(file, in, "checksum", 0);
    for (const char* name : {"stored_type", "notes", "source", "warnings", "geometry_source", "length_unit"})
        put_text(file, in, name, "uint8");
    put_dataset(file, in, "/histogram", {kPackedBins}, SampleType::UInt64, 12);
    put_dataset(file, in, "/levels/0/samples", {2, 2, 3}, SampleType::UInt8, 0);
    for (const char* name : {"low", "high"})
        put_dataset(file, in, level_path(0, name), {1, 1, 1}, SampleType::Float32, 0);
    const bool labels = (in.byte() & 1U) != 0;
    put_whole(file, in, "labels", labels ? 1 : 0);
    put_whole(file, in, "labels_signed", 0);
    if (labels) {
        put_dataset(file, in, "/labels/ids", {1}, SampleType::UInt64, 0);
        put_dataset(file, in, "/labels/voxels", {1}, SampleType::UInt64, 12);
        put_dataset(file, in, "/labels/colors", {1, 3}, SampleType::Float64, 0);
        put_dataset(file, in, "/labels/names", {1}, SampleType::UInt8, 0);
    }
    file.close();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::string path = (fuzz::folder() / "volume.esv").string();
    std::filesystem::remove(path);
    Input in(data, size);
    try {
        make(path, in);
        const Volume volume = open_packed(path);
        const glm::ivec3 last = volume.geometry.dims - 1;
        (void)value_at(volume, last);
        (void)volume.packed->range(0, glm::ivec3(0), glm::min(volume.geometry.dims, glm::ivec3(100)));
        (void)load_level(volume, volume.packed->levels() - 1);
    } catch (const Error&) {
    }
    return 0;
}
