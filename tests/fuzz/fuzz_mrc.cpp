// MRC and CCP4 maps: a header of 1024 bytes, an extended header and its voxels, plain or gzip.
#include "tests/fuzz/fuzz_file.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    edgesplat::fuzz::load("volume.mrc", edgesplat::fuzz::text_of(data, size));
    return 0;
}
