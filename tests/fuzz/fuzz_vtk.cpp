// Legacy VTK files. The first line is replaced where it is none of theirs, as other first bytes are other formats.
#include "tests/fuzz/fuzz_file.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    std::string text(edgesplat::fuzz::text_of(data, size));
    if (!text.starts_with("# vtk DataFile")) text = "# vtk DataFile Version 3.0\n" + text;
    edgesplat::fuzz::load("volume.vtk", text);
    return 0;
}
