// Archives and compressed files of volumes, and headers of Voreen and Inviwo with their data in the 64 bytes of
// data.raw. The libraries that unpack are not instrumented.
#include "tests/fuzz/fuzz_file.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    static const std::string beside = edgesplat::fuzz::write("data.raw", std::string(64, 'x'));
    edgesplat::fuzz::load("volume.dat", edgesplat::fuzz::text_of(data, size));
    return 0;
}
