// MGH: a header of 284 bytes and its voxels, plain or gzip.
#include "tests/fuzz/fuzz_file.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    edgesplat::fuzz::load("volume.mgh", edgesplat::fuzz::text_of(data, size));
    return 0;
}
