// NumPy: .npy files, and .npz archives of them.
#include "tests/fuzz/fuzz_file.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::string_view text = edgesplat::fuzz::text_of(data, size);
    edgesplat::fuzz::load(text.starts_with("PK") ? "volume.npz" : "volume.npy", text);
    return 0;
}
