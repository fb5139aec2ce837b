// NIfTI-1, NIfTI-2 and Analyze: a header followed by its voxels, plain or gzip.
#include "tests/fuzz/fuzz_file.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    edgesplat::fuzz::load("volume.nii", edgesplat::fuzz::text_of(data, size));
    return 0;
}
