#include "engine/checked_file.h"

#include <algorithm>
#include <array>
#include <fstream>
#include <system_error>

#include "engine/fnv1a.h"
#include "footprints/temporary_file.h"

namespace edgesplat {
namespace {

namespace fs = std::filesystem;

struct CheckedHeader {
    std::array<char, 8> kind{};
    std::uint64_t bytes = 0, checksum = 0;
    bool operator==(const CheckedHeader&) const = default;
};

std::string_view text_of(const std::vector<std::uint8_t>& bytes) {
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

CheckedHeader header_of(std::string_view kind, const std::vector<std::uint8_t>& bytes) {
    CheckedHeader header;
    std::ranges::copy(kind.substr(0, header.kind.size()), header.kind.begin());
    header.bytes = bytes.size();
    header.checksum = fnv1a(text_of(bytes));
    return header;
}

}  // namespace

std::vector<std::uint8_t> read_checked_file(const fs::path& file, std::string_view kind) {
    std::error_code error;
    if (!fs::is_regular_file(file, error)) return {};  // opening a FIFO would block
    const auto size = fs::file_size(file, error);
    std::ifstream in(file, std::ios::binary);
    CheckedHeader header;
    if (error || !in.read(reinterpret_cast<char*>(&header), sizeof header)) return {};
    if (header.kind != header_of(kind, {}).kind || header.bytes != size - sizeof header) return {};
    std::vector<std::uint8_t> bytes(header.bytes);
    in.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
    return in && header == header_of(kind, bytes) ? bytes : std::vector<std::uint8_t>{};
}

bool write_checked_file(const fs::path& file, std::string_view kind, const std::vector<std::uint8_t>& bytes) {
    const CheckedHeader header = header_of(kind, bytes);
    std::error_code ignored;
    fs::create_directories(file.parent_path(), ignored);
    const DeferSignals defer;
    try {
        TemporaryFile out(file);
        out.write({reinterpret_cast<const char*>(&header), sizeof header});
        out.write(text_of(bytes));
        out.rename_to_target();
    } catch (const std::system_error&) {
        return false;
    }
    return true;
}

}  // namespace edgesplat
