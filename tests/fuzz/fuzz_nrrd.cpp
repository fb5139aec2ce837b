// NRRD headers with their data in the same file, or in the 64 bytes of data.raw.
#include "engine/error.h"
#include "engine/volume/pack_source_internal.h"
#include "tests/fuzz/fuzz_file.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    static const std::string beside = edgesplat::fuzz::write("data.raw", std::string(64, 'x'));
    if (!edgesplat::fuzz::text_of(data, size).starts_with("NRRD0")) return 0;  // otherwise it is another format
    const std::string path = edgesplat::fuzz::load("volume.nrrd", edgesplat::fuzz::text_of(data, size));
    try {  // as `edgesplat pack` reads it
        edgesplat::Volume description;
        const auto layout = edgesplat::detail::nrrd_layout(path, description);
        std::vector<float> sample(1);
        if (layout) edgesplat::detail::file_source(*layout, description)->read(glm::ivec3(0), glm::ivec3(1), sample);
    } catch (const edgesplat::Error&) {
    }
    return 0;
}
