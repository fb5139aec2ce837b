#include "engine/gpu/pipeline_cache_file.h"

#include <array>
#include <fstream>
#include <string_view>
#include <system_error>

#include "engine/fnv1a.h"
#include "footprints/temporary_file.h"

namespace edgesplat::gpu {
namespace {

namespace fs = std::filesystem;

// Drivers check that cache data is their own, but not all check that it is undamaged: hence the checksum.
struct Header {
    std::array<char, 8> magic = {'E', 'S', 'P', 'L', 'A', 'T', 'P', 'C'};
    std::uint64_t bytes = 0, checksum = 0;
    bool operator==(const Header&) const = default;
};

std::string_view bytes_of(const std::vector<std::uint8_t>& data) {
    return {reinterpret_cast<const char*>(data.data()), data.size()};
}

Header header_of(const std::vector<std::uint8_t>& data) {
    Header header;
    header.bytes = data.size();
    header.checksum = fnv1a(bytes_of(data));
    return header;
}

}  // namespace

std::vector<std::uint8_t> read_pipeline_cache_file(const fs::path& file) {
    std::error_code error;
    if (!fs::is_regular_file(file, error)) return {};  // opening a FIFO would block
    const auto size = fs::file_size(file, error);
    std::ifstream in(file, std::ios::binary);
    Header header;
    if (error || !in.read(reinterpret_cast<char*>(&header), sizeof header)) return {};
    if (header.magic != Header{}.magic || header.bytes != size - sizeof header) return {};
    std::vector<std::uint8_t> data(header.bytes);
    in.read(reinterpret_cast<char*>(data.data()), static_cast<std::streamsize>(data.size()));
    return in && header == header_of(data) ? data : std::vector<std::uint8_t>{};
}

bool write_pipeline_cache_file(const fs::path& file, const std::vector<std::uint8_t>& data) {
    const Header header = header_of(data);
    std::error_code ignored;
    fs::create_directories(file.parent_path(), ignored);
    const DeferSignals defer;
    try {
        TemporaryFile out(file);
        out.write({reinterpret_cast<const char*>(&header), sizeof header});
        out.write(bytes_of(data));
        out.rename_to_target();
    } catch (const std::system_error&) {
        return false;
    }
    return true;
}

}  // namespace edgesplat::gpu
