// The pipeline cache file. The first byte of the input is ignored.
#include <cstdlib>

#include "engine/gpu/pipeline_cache_file.h"
#include "tests/fuzz/fuzz_file.h"

using namespace edgesplat;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    if (size == 0) return 0;
    const std::string path = fuzz::write("cache.bin", fuzz::text_of(data + 1, size - 1));
    const auto content = gpu::read_pipeline_cache_file(path);
    if (content.size() > size) std::abort();
    return 0;
}
