// Formats with small headers: GIPL, raw data with a description in the first line, MINC1, and the check of netCDF files
// before their library reads them. OpenImageIO itself is not fuzzed.
#include "engine/error.h"
#include "engine/volume/io/readers.h"
#include "tests/fuzz/fuzz_file.h"

using edgesplat::fuzz::load;
using edgesplat::fuzz::write;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::string_view text = edgesplat::fuzz::text_of(data, size);
    if (text.starts_with("raw ")) {
        const std::size_t end = text.find('\n');
        if (end == std::string_view::npos) return 0;
        const std::string path = write("volume.raw", text.substr(end + 1));
        try {
            (void)edgesplat::load_volume(path, {.raw = std::string(text.substr(4, end - 4))});
        } catch (const edgesplat::Error&) {
        }
    } else if (text.starts_with("CDF")) {
        const std::string path = write("volume.bin", text);
        load("volume.mnc", text);
        try {
            edgesplat::detail::check_netcdf_is_whole(path);
        } catch (const edgesplat::Error&) {
        }
    } else {
        load("volume.gipl", text);
    }
    return 0;
}
