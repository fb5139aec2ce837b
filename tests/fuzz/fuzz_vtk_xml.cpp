// VTK's XML files of image data and rectilinear grids. Parallel files find part.vti beside them.
#include "tests/fuzz/fuzz_file.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    static const std::string part = edgesplat::fuzz::write(
        "part.vti",
        "<VTKFile type=\"ImageData\"><ImageData WholeExtent=\"0 1 0 1 0 1\"><Piece Extent=\"0 1 0 1 0 1\"><PointData>"
        "<DataArray type=\"UInt8\" Name=\"a\">1 2 3 4 5 6 7 8</DataArray></PointData></Piece></ImageData></VTKFile>");
    const std::string_view text = edgesplat::fuzz::text_of(data, size);
    if (text.substr(0, 1024).find("<VTKFile") == std::string_view::npos) return 0;  // otherwise it is another format
    edgesplat::fuzz::load("volume.vti", text);
    return 0;
}
