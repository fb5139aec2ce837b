// Reads GIPL through ITK.
#include <zlib.h>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <vector>

#include "engine/volume/io/readers.h"

namespace edgesplat::detail {

// ITK's reader reads missing voxels as 0.
Volume load_gipl(const std::string& path, const LoadOptions& options) {
    constexpr std::size_t kHeader = 256;
    const auto check_data = [&](std::size_t bytes, std::size_t) {
        const std::unique_ptr<gzFile_s, int (*)(gzFile)> file(gzopen(path.c_str(), "rb"), &gzclose);
        std::vector<char> part(1 << 16);
        std::size_t found = 0;
        for (int count = 1; file && count > 0 && found < kHeader + bytes; found += static_cast<std::size_t>(count))
            count = std::max(gzread(file.get(), part.data(), static_cast<unsigned>(part.size())), 0);
        if (found < kHeader + bytes)
            fail("{}: truncated: {} of {} bytes of voxels", path, found - std::min(found, kHeader), bytes);
    };
    return load_through_itk({.format = ItkFormat::Gipl,
                             .path = path,
                             .stored_bytes = std::filesystem::file_size(path),
                             .check_data = check_data},
                            options);
}

}  // namespace edgesplat::detail
