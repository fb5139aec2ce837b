// Zarr hierarchies. The first byte is the kind: '2' and '3', an array by that version; 'o', an OME-Zarr image of one
// level; 'z', a zip archive. The files follow, separated by empty lines: attributes of the group (only 'o'), metadata
// of the array, and the chunk, which is found under several names. blosc, zstd and lz4 are not instrumented.
#include <algorithm>
#include <cstdlib>
#include <filesystem>

#include "engine/volume/io/zarr.h"
#include "tests/fuzz/fuzz_file.h"

namespace {

/// Removes the text up to the next empty line.
std::string_view next_file(std::string_view& text) {
    const std::size_t end = std::min(text.find("\n\n"), text.size());
    const std::string_view file = text.substr(0, end);
    text.remove_prefix(std::min(end + 2, text.size()));
    return file;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    namespace fs = std::filesystem;
    using edgesplat::fuzz::write;
    std::string_view text = edgesplat::fuzz::text_of(data, size);
    if (text.empty()) return 0;
    const char kind = text[0];
    text.remove_prefix(1);
    std::string path;
    if (kind == 'z') {
        path = write("volume.zarr.zip", text);
    } else {
        path = (edgesplat::fuzz::folder() / "volume.zarr").string();
        std::error_code ignored;
        fs::remove_all(path, ignored);
        const std::string array = kind == 'o' ? "volume.zarr/0" : "volume.zarr";
        fs::create_directories(edgesplat::fuzz::folder() / array / "c" / "0" / "0", ignored);
        if (kind == 'o') write("volume.zarr/.zattrs", next_file(text));
        write(array + (kind == '3' ? "/zarr.json" : "/.zarray"), next_file(text));
        for (const char* name : {"/0.0.0", "/0.0.1", "/c/0/0/0", "/c/0/0/1", "/c.0.0.0", "/0.0.0.0"})
            write(array + name, text);
    }
    try {
        const edgesplat::Volume volume = edgesplat::detail::load_zarr(path, {.component = 0, .frame = 0});
        if (volume.values.size() != volume.geometry.voxel_count()) std::abort();
    } catch (const edgesplat::Error&) {
    }
    return 0;
}
