// A file that is kept between runs. The first byte of the input is ignored.
#include <cstdlib>

#include "engine/checked_file.h"
#include "tests/fuzz/fuzz_file.h"

using namespace edgesplat;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    if (size == 0) return 0;
    const std::string path = fuzz::write("cache.bin", fuzz::text_of(data + 1, size - 1));
    const auto content = read_checked_file(path, "ESPLATPC");
    if (content.size() > size) std::abort();
    return 0;
}
