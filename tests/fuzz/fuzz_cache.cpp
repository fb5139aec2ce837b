// What is kept from run to run: the first byte says whether the others are a footprint table ('f') or the file of
// compiled pipelines.
#include <cstdlib>

#include "engine/gpu/pipeline_cache_file.h"
#include "footprints/footprint_cache.h"
#include "tests/fuzz/fuzz_file.h"

using namespace edgesplat;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    if (size == 0) return 0;
    const std::string path = fuzz::write("cache.bin", fuzz::text_of(data + 1, size - 1));
    if (data[0] != 'f') {
        const auto content = gpu::read_pipeline_cache_file(path);
        if (content.size() > size) std::abort();
        return 0;
    }
    std::string problem;
    const auto table = read_footprint_table(path, {.half_width = 1, .strength = 4},
                                            {.width = 4, .height = 3, .distances = 3, .directions = 2}, problem);
    if (!table && problem.empty()) std::abort();
    if (table) (void)table->lerp({}, 0.3);
    return 0;
}
