// netCDF files of the classic formats. Version 4 is HDF5, whose library is not ours to fuzz.
#include "tests/fuzz/fuzz_file.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::string_view content = edgesplat::fuzz::text_of(data, size);
    if (content.starts_with("CDF")) (void)edgesplat::fuzz::load("volume.nc", content);
    return 0;
}
