// Reads legacy VTK image data through ITK.
#include <cctype>
#include <filesystem>
#include <fstream>

#include "engine/volume/io/readers.h"

namespace edgesplat::detail {

Volume load_vtk_legacy(const std::string& path, const std::string& head, const LoadOptions& options) {
    std::string upper;
    for (const char c : head)
        upper += static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
    const auto at = upper.find("\nDATASET");
    if (at != std::string::npos && upper.find("STRUCTURED_POINTS", at) == std::string::npos)
        fail("{}: a VTK file, but not image data (DATASET STRUCTURED_POINTS)", path);
    // ITK's reader leaves missing values of a short file uninitialised. The values begin after the line that names
    // their lookup table, or after the line that names the values if there is no table.
    std::size_t begin = 0;
    for (const char* key : {"\nLOOKUP_TABLE", "\nSCALARS", "\nCOLOR_SCALARS", "\nVECTORS", "\nTENSORS"}) {
        const auto found = upper.find(key);
        if (found == std::string::npos) continue;
        begin = upper.find('\n', found + 1);
        break;
    }
    if (begin == 0 || begin == std::string::npos) fail("{}: a VTK file without values at its points", path);
    const bool ascii = upper.find("\nASCII") != std::string::npos;
    const auto check_data = [&](std::size_t bytes, std::size_t samples) {
        const std::size_t stored = std::filesystem::file_size(path) - begin - 1;
        if (!ascii && bytes > stored) fail("{}: truncated: {} of {} bytes of voxels", path, stored, bytes);
        if (!ascii) return;
        std::ifstream file(path);
        file.seekg(static_cast<std::streamoff>(begin));
        std::size_t found = 0;
        for (std::string word; found < samples && file >> word;)
            ++found;
        if (found < samples) fail("{}: truncated: {} of {} values", path, found, samples);
    };
    return load_through_itk({.format = ItkFormat::Vtk, .path = path, .check_data = check_data}, options);
}

}  // namespace edgesplat::detail
