// HDF5 files of other programs: the input chooses arrays, their sizes and their attributes, which are written through
// HDF5. Damaged HDF5 is not fuzzed here.
#include <cmath>
#include <cstring>

#include "engine/error.h"
#include "engine/volume/io/hdf5.h"
#include "tests/fuzz/fuzz_file.h"

using namespace edgesplat;
using namespace edgesplat::detail;

namespace {

constexpr const char* kArrays[] = {"/data", "/a/b", "/ITKImage/0/VoxelData", "/VTKHDF/PointData/v",
                                   "/DataSet/ResolutionLevel 0/TimePoint 0/Channel 0/Data"};
constexpr const char* kNumbers[] = {"element_size_um", "voxel_size",   "resolution",
                                    "Spacing",         "scale_factor", "_FillValue"};
constexpr const char* kTexts[] = {"unit", "axistags", "CLASS", "Type"};

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const auto next = [&]() -> std::uint8_t {
        if (size == 0) return 0;
        --size;
        return *data++;
    };
    const auto number = [&] {
        double value = next();
        const std::uint8_t how = next();
        if (how > 250) value = std::nan("");
        if (how < 3) value = -value;
        return how > 240 && how <= 250 ? std::ldexp(value, 1000) : value;
    };
    const std::string path = (fuzz::folder() / "volume.h5").string();
    Hdf5File file = Hdf5File::create(path, path);
    for (int left = 1 + next() % 2; left > 0; --left) {
        const std::string name = kArrays[next() % std::size(kArrays)];
        if (file.has(name)) continue;
        Hdf5Extent extent(next() % 6);
        for (auto& side : extent)
            side = next() % 9;
        if (next() > 250 && !extent.empty()) extent[0] = std::uint64_t{1} << (next() % 63);
        const bool chunks = next() % 2 == 1;
        std::uint64_t total = 1;
        for (const auto side : extent)
            total *= side > 9 ? 0 : side;
        for (auto& side : extent)
            side = chunks && side == 0 ? 1 : side;
        try {
            const auto array = file.create_dataset(
                name, {static_cast<SampleType>(next() % 10), extent, chunks ? std::uint64_t{2} : 0, chunks});
            if (total > 0 && total < 4096)
                array.write(Hdf5Extent(extent.size(), 0), extent, SampleType::Float64,
                            std::vector<double>(total * 2, 1).data());
        } catch (const Error&) {
            continue;
        }
    }
    try {
        for (int left = next() % 4; left > 0; --left) {
            std::vector<double> values(1 + next() % 9);
            for (double& value : values)
                value = number();
            file.set_numbers(kNumbers[next() % std::size(kNumbers)], SampleType::Float64, {values.size()},
                             values.data());
        }
        for (int left = next() % 3; left > 0; --left) {
            std::string text(next() % 40, ' ');
            for (char& c : text)
                c = static_cast<char>(next());
            file.set_text(kTexts[next() % std::size(kTexts)], text.c_str());
        }
    } catch (const Error&) {  // NOLINT(bugprone-empty-catch): an attribute that is there already
    }
    file.close();
    try {
        (void)load_volume(path);
    } catch (const Error&) {  // NOLINT(bugprone-empty-catch): expected
    }
    return 0;
}
