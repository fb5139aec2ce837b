#include "footprints/footprint_cache.h"

#include <fmt/format.h>

#include <array>
#include <bit>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <optional>
#include <string_view>
#include <system_error>

#include "footprints/temporary_file.h"

namespace edgesplat {
namespace {

namespace fs = std::filesystem;

// Raise it whenever the texels' meaning changes: coordinates, kernel, warp, quadrature.
constexpr std::uint32_t kVersion = 1;
constexpr std::array<char, 8> kMagic = {'E', 'S', 'P', 'L', 'A', 'T', 'F', 'T'};

// The file is this header and the texels, in the machine's byte order: a cache is not carried between machines, and a
// foreign order fails the version check.
struct Header {
    std::array<char, 8> magic = kMagic;
    std::uint32_t version = kVersion;
    std::int32_t width = 0, height = 0, distances = 0, directions = 0;
    std::uint32_t reserved = 0;
    double half_width = 0, strength = 0;
    std::uint64_t checksum = 0;  // of the texels
    bool operator==(const Header&) const = default;
};
static_assert(sizeof(Header) == 56);

// FNV-1a over 64-bit words: a table is read in a millisecond, a bytewise sum would take longer than the reading.
std::uint64_t checksum_of(std::span<const std::uint16_t> texels) {
    std::uint64_t hash = 0xcbf29ce484222325u;
    const auto mix = [&](std::uint64_t word) { hash = std::rotl((hash ^ word) * 0x100000001b3u, 29); };
    std::size_t i = 0;
    for (; i + 4 <= texels.size(); i += 4) {
        std::uint64_t word = 0;
        std::memcpy(&word, texels.data() + i, sizeof word);
        mix(word);
    }
    for (; i < texels.size(); ++i)
        mix(texels[i]);
    return hash;
}

Header header_of(const EdgeBand& band, const FootprintTableSize& size) {
    Header header;
    header.width = size.width;
    header.height = size.height;
    header.distances = size.distances;
    header.directions = size.directions;
    header.half_width = band.half_width;
    header.strength = band.strength;
    return header;
}

// Writes beside the file and renames: readers see the old file, the new one or none. Returns what went wrong, or
// nothing.
std::string write(const fs::path& file, const FootprintTable& table) {
    std::error_code error;
    fs::create_directories(file.parent_path(), error);
    if (error) return fmt::format("{}: {}; footprints are not cached", file.parent_path().string(), error.message());
    Header header = header_of(table.band(), table.size());
    header.checksum = checksum_of(table.texels());
    const auto bytes = [](const void* data, std::size_t count) {
        return std::string_view(static_cast<const char*>(data), count);
    };
    const DeferSignals defer;
    try {
        TemporaryFile out(file);
        out.write(bytes(&header, sizeof header));
        out.write(bytes(table.texels().data(), table.texels().size_bytes()));
        out.rename_to_target();
    } catch (const std::system_error& problem) {
        return fmt::format("{}: {}; footprints are not cached", file.string(), problem.code().message());
    }
    return {};
}

}  // namespace

fs::path footprint_cache_folder() {
    const auto variable = [](const char* name) -> fs::path {
        const char* value = std::getenv(name);
        return value ? value : "";
    };
    if (fs::path own = variable("EDGESPLAT_CACHE"); !own.empty()) return own;
    if (fs::path xdg = variable("XDG_CACHE_HOME"); xdg.is_absolute()) return xdg / "edgesplat";
    if (fs::path home = variable("HOME"); !home.empty()) return home / ".cache" / "edgesplat";
    return {};
}

fs::path footprint_cache_file(const fs::path& folder, const EdgeBand& band, const FootprintTableSize& size) {
    // {} prints the shortest text that reads back as the same number: different bands never share a name.
    return folder / fmt::format("footprints-v{}-a{}-k{}-{}x{}x{}x{}.table", kVersion, band.half_width, band.strength,
                                size.width, size.height, size.distances, size.directions);
}

std::optional<FootprintTable> read_footprint_table(const fs::path& file, const EdgeBand& band,
                                                   const FootprintTableSize& size, std::string& problem) {
    std::error_code ignored;
    if (!fs::exists(file, ignored)) return std::nullopt;
    // Opening a FIFO would wait for ever, so the kind of file comes first.
    std::ifstream in;
    if (fs::is_regular_file(file, ignored)) in.open(file, std::ios::binary);
    if (!in.is_open()) {
        problem = fmt::format("{}: cannot be read; rebuilt", file.string());
        return std::nullopt;
    }
    Header header;
    in.read(reinterpret_cast<char*>(&header), sizeof header);
    Header expected = header_of(band, size);
    expected.checksum = header.checksum;
    if (!in || !(header == expected)) {
        problem = fmt::format("{}: not a footprint table of this version and these parameters; rebuilt", file.string());
        return std::nullopt;
    }
    std::vector<std::uint16_t> texels(size.texels());
    const auto bytes = static_cast<std::streamsize>(texels.size() * sizeof texels[0]);
    in.read(reinterpret_cast<char*>(texels.data()), bytes);
    if (in.gcount() != bytes || in.peek() != std::ifstream::traits_type::eof() ||
        checksum_of(texels) != header.checksum) {
        problem = fmt::format("{}: damaged (wrong length or checksum); rebuilt", file.string());
        return std::nullopt;
    }
    return FootprintTable(band, size, std::move(texels));
}

LoadedFootprintTable load_footprint_table(const EdgeBand& band, const FootprintTableSize& size,
                                          const fs::path& folder) {
    validate(band, size);
    if (folder.empty())
        return {FootprintTable::build(band, size), false, "no cache folder is set; footprints are not cached"};
    const fs::path file = footprint_cache_file(folder, band, size);
    std::string warning;
    if (auto cached = read_footprint_table(file, band, size, warning)) return {std::move(*cached), true, {}};
    FootprintTable table = FootprintTable::build(band, size);
    // What keeps it from being written matters more than what was wrong with the old one.
    if (std::string problem = write(file, table); !problem.empty()) warning = std::move(problem);
    return {std::move(table), false, std::move(warning)};
}

}  // namespace edgesplat
