// TIFF files with their directories, OME-XML and descriptions of ImageJ and tifffile, and the pictures that are decoded
// here: PNG, GIF, portable maps, BMP with a palette. libtiff and libpng are not instrumented.
#include "engine/volume/io/exact_pictures.h"
#include "engine/volume/io/tiff.h"
#include "tests/fuzz/fuzz_file.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::string_view text = edgesplat::fuzz::text_of(data, size);
    if (edgesplat::detail::begins_as_tiff(text) || edgesplat::detail::begins_as_exact_picture(text))
        edgesplat::fuzz::load("volume.tif", text);
    return 0;
}
