// Reads the directories of TIFF files.
#include "engine/volume/io/tiff_file.h"

#include <algorithm>
#include <bit>
#include <cstring>
#include <unordered_set>

#include "engine/volume/io/readers.h"

namespace edgesplat::detail {
namespace {

enum TiffTag : std::uint16_t {
    kNewSubfileType = 254,
    kSubfileType = 255,
    kImageWidth = 256,
    kImageLength = 257,
    kBitsPerSample = 258,
    kCompression = 259,
    kPhotometric = 262,
    kImageDescription = 270,
    kStripOffsets = 273,
    kOrientation = 274,
    kSamplesPerPixel = 277,
    kRowsPerStrip = 278,
    kStripByteCounts = 279,
    kXResolution = 282,
    kYResolution = 283,
    kPlanarConfig = 284,
    kResolutionUnit = 296,
    kTileWidth = 322,
    kTileLength = 323,
    kTileOffsets = 324,
    kTileByteCounts = 325,
    kSampleFormat = 339,
    kImageDepth = 32997,
    kUic2 = 33629,  // MetaMorph
    kModelPixelScale = 33550,
    kLsmInfo = 34412,
    kGdalMetadata = 42112,
    kGdalNoData = 42113
};

/// Bytes of a value of a field's type; 0: unknown type.
std::uint64_t bytes_of_field_type(std::uint16_t type) {
    constexpr std::uint8_t kBytes[] = {0, 1, 1, 2, 4, 8, 1, 1, 2, 4, 8, 4, 8, 4, 0, 0, 8, 8, 8};
    return type < std::size(kBytes) ? kBytes[type] : 0;
}

template <typename T>
T swapped_bytes(T value) {
    auto bytes = std::bit_cast<std::array<unsigned char, sizeof(T)>>(value);
    std::reverse(bytes.begin(), bytes.end());
    return std::bit_cast<T>(bytes);
}

}  // namespace

bool begins_as_tiff(std::string_view head) {
    using namespace std::string_view_literals;
    return head.starts_with("II*\0"sv) || head.starts_with("MM\0*"sv) || head.starts_with("II+\0"sv) ||
           head.starts_with("MM\0+"sv);
}

/// Reads a TiffFile while it is open.
class TiffDirectoryReader {
  public:
    explicit TiffDirectoryReader(const TiffFile& file) : file_(file), in_(file.path_, std::ios::binary) {
        if (!in_) fail("{}: cannot be read", file.path_);
    }

    /// Fills `file`, the one of the constructor.
    void read_all(TiffFile& file) {
        const std::string head = get(0, 8);
        if (!begins_as_tiff(head)) fail("{}: not a TIFF file", file_.path_);
        file.swapped_ = (head[0] == 'M') != (std::endian::native == std::endian::big);
        big_ = head[2] == '+' || head[3] == '+';
        if (big_ && (number<std::uint16_t>(head, 4) != 8 || number<std::uint16_t>(head, 6) != 0))
            fail("{}: BigTIFF with offsets of {} bytes, expected 8", file_.path_, number<std::uint16_t>(head, 4));
        std::uint64_t next = big_ ? offset(get(8, 8), 0) : offset(head, 4);
        std::unordered_set<std::uint64_t> seen;
        while (next != 0) {
            if (!seen.insert(next).second)
                fail("{}: its directory at byte {} is listed twice: the chain of pages has no end", file_.path_, next);
            next = read_directory(next, file);
        }
        if (file_.pages_.empty()) fail("{}: a TIFF file without pages", file_.path_);
    }

    std::string get(std::uint64_t at, std::uint64_t count) {
        if (at > file_.size_ || count > file_.size_ - at)
            fail("{}: truncated: {} bytes at byte {}, but the file has {}", file_.path_, count, at, file_.size_);
        std::string bytes(static_cast<std::size_t>(count), '\0');
        in_.seekg(static_cast<std::streamoff>(at));
        in_.read(bytes.data(), static_cast<std::streamsize>(count));
        if (!in_) fail("{}: cannot be read at byte {}", file_.path_, at);
        return bytes;
    }

    double real(const TiffField& field, const std::string& bytes, std::uint64_t index) const {
        const auto at = static_cast<std::size_t>(index * bytes_of_field_type(field.type));
        switch (field.type) {
            case 5: {
                const double over = number<std::uint32_t>(bytes, at), under = number<std::uint32_t>(bytes, at + 4);
                return over / under;
            }
            case 10: {
                const double over = number<std::int32_t>(bytes, at), under = number<std::int32_t>(bytes, at + 4);
                return over / under;
            }
            case 11:
                return static_cast<double>(std::bit_cast<float>(number<std::uint32_t>(bytes, at)));
            case 12:
                return std::bit_cast<double>(number<std::uint64_t>(bytes, at));
            default:
                return static_cast<double>(whole(field, bytes, index));
        }
    }

    std::uint64_t whole(const TiffField& field, const std::string& bytes, std::uint64_t index) const {
        const auto at = static_cast<std::size_t>(index * bytes_of_field_type(field.type));
        switch (field.type) {
            case 1:
            case 7:
                return static_cast<unsigned char>(bytes[at]);
            case 3:
                return number<std::uint16_t>(bytes, at);
            case 4:
            case 13:
                return number<std::uint32_t>(bytes, at);
            case 16:
            case 18:
                return number<std::uint64_t>(bytes, at);
            default:
                fail("{}: TIFF field {} has values of type {}, expected whole numbers", file_.path_, field.tag,
                     field.type);
        }
    }

    std::string values_of(const TiffField& field) {
        std::uint64_t bytes = 0;
        if (__builtin_mul_overflow(field.count, bytes_of_field_type(field.type), &bytes) || bytes > file_.size_)
            fail("{}: TIFF field {} has {} values, more than the file holds: truncated, or the header is wrong",
                 file_.path_, field.tag, field.count);
        return get(field.at, bytes);
    }

  private:
    template <typename T>
    T number(const std::string& bytes, std::size_t at) const {
        T value;
        std::memcpy(&value, bytes.data() + at, sizeof value);
        return file_.swapped_ ? swapped_bytes(value) : value;
    }

    std::uint64_t offset(const std::string& bytes, std::size_t at) const {
        return big_ ? number<std::uint64_t>(bytes, at) : number<std::uint32_t>(bytes, at);
    }

    std::uint64_t read_directory(std::uint64_t at, TiffFile& file) {
        const std::size_t count_bytes = big_ ? 8 : 2, entry_bytes = big_ ? 20 : 12, offset_bytes = big_ ? 8 : 4;
        const std::string head = get(at, count_bytes);
        const std::uint64_t count = big_ ? number<std::uint64_t>(head, 0) : number<std::uint16_t>(head, 0);
        if (count == 0 || count > 4096)
            fail("{}: its directory at byte {} has {} fields, expected 1 to 4096", file_.path_, at, count);
        const std::string entries = get(at + count_bytes, count * entry_bytes + offset_bytes);
        TiffPage page{.directory = at};
        for (std::uint64_t i = 0; i < count; ++i) {
            const auto entry = static_cast<std::size_t>(i * entry_bytes);
            TiffField field{.tag = number<std::uint16_t>(entries, entry),
                            .type = number<std::uint16_t>(entries, entry + 2),
                            .count = offset(entries, entry + 4)};
            const std::size_t value_at = entry + 4 + offset_bytes;
            const std::uint64_t size = bytes_of_field_type(field.type);
            if (size == 0) continue;
            const bool is_inside = field.count <= offset_bytes / size;
            field.at = is_inside ? at + count_bytes + value_at : offset(entries, value_at);
            take(page, field);
        }
        check_blocks(page);
        file.pages_.push_back(std::move(page));
        return offset(entries, static_cast<std::size_t>(count * entry_bytes));
    }

    std::uint64_t first_number(const TiffField& field) {
        if (field.count == 0) fail("{}: TIFF field {} has no value", file_.path_, field.tag);
        return whole(field, get(field.at, bytes_of_field_type(field.type)), 0);
    }

    /// The value that all samples have; sets is_mixed if they differ.
    std::uint64_t common_number(const TiffField& field, TiffPage& page) {
        const std::string bytes = values_of(field);
        if (field.count == 0) fail("{}: TIFF field {} has no value", file_.path_, field.tag);
        const std::uint64_t first = whole(field, bytes, 0);
        for (std::uint64_t i = 1; i < field.count; ++i)
            page.is_mixed = page.is_mixed || whole(field, bytes, i) != first;
        return first;
    }

    std::string text(const TiffField& field) {
        std::string bytes = values_of(field);
        bytes.resize(std::min(bytes.size(), bytes.find('\0')));
        return bytes;
    }

    /// 0 if the field says nothing; infinite if its denominator is 0.
    double resolution(const TiffField& field) {
        if (field.count == 0) return 0;
        const double value = real(field, values_of(field), 0);
        return value == value ? value : 0;
    }

    void take(TiffPage& page, const TiffField& field) {
        switch (field.tag) {
            case kNewSubfileType: {
                const std::uint64_t kind = first_number(field);
                page.is_reduced = (kind & 1) != 0;
                page.is_mask = (kind & 4) != 0;
                break;
            }
            case kSubfileType:
                page.is_reduced = page.is_reduced || first_number(field) == 2;
                break;
            case kImageWidth:
                page.width = first_number(field);
                break;
            case kImageLength:
                page.height = first_number(field);
                break;
            case kImageDepth:
                page.depth = first_number(field);
                break;
            case kBitsPerSample:
                page.bits = common_number(field, page);
                break;
            case kSampleFormat:
                page.format = common_number(field, page);
                page.says_format = true;
                break;
            case kCompression:
                page.compression = first_number(field);
                break;
            case kPhotometric:
                page.photometric = first_number(field);
                break;
            case kImageDescription:
                page.descriptions.push_back(text(field));
                break;
            case kSamplesPerPixel:
                page.samples = first_number(field);
                break;
            case kRowsPerStrip:
                page.rows_per_strip = first_number(field);
                break;
            case kPlanarConfig:
                page.planar = first_number(field);
                break;
            case kTileWidth:
                page.tile_width = first_number(field);
                break;
            case kTileLength:
                page.tile_height = first_number(field);
                break;
            case kXResolution:
                page.x_resolution = resolution(field);
                break;
            case kYResolution:
                page.y_resolution = resolution(field);
                break;
            case kOrientation:
                page.orientation = first_number(field);
                break;
            case kResolutionUnit:
                page.resolution_unit = first_number(field);
                break;
            case kStripOffsets:
            case kTileOffsets:
                page.offsets = field;
                break;
            case kStripByteCounts:
            case kTileByteCounts:
                page.counts = field;
                break;
            case kLsmInfo:
                page.lsm = field;
                break;
            case kUic2:
                page.is_metamorph = true;
                break;
            case kModelPixelScale:
                page.is_geo = true;
                break;
            case kGdalMetadata:
                page.gdal_metadata = text(field);
                break;
            case kGdalNoData:
                page.no_data = text(field);
                break;
            default:
                break;
        }
    }

    /// Sets what is known about the strips or tiles.
    void check_blocks(TiffPage& page) {
        if (page.offsets.tag == 0) return;
        const std::string offsets = values_of(page.offsets);
        const bool has_counts = page.counts.tag != 0 && page.counts.count == page.offsets.count;
        const std::string counts = has_counts ? values_of(page.counts) : "";
        std::uint64_t end = 0;
        page.is_contiguous = page.offsets.count > 0;
        for (std::uint64_t i = 0; i < page.offsets.count; ++i) {
            const std::uint64_t here = whole(page.offsets, offsets, i);
            // Without counts, as some writers leave them, libtiff estimates them from the file's size.
            const std::uint64_t bytes = has_counts ? whole(page.counts, counts, i) : file_.size_;
            if (i == 0) page.first = here;
            page.is_contiguous = page.is_contiguous && (i == 0 || here == end);
            page.has_missing = page.has_missing || (has_counts && here == 0 && bytes == 0);
            if (__builtin_add_overflow(page.stored, std::min(bytes, file_.size_), &page.stored))
                page.stored = file_.size_;
            end = here + bytes;
        }
    }

    const TiffFile& file_;
    std::ifstream in_;
    bool big_ = false;
};

TiffFile::TiffFile(const std::string& path) : path_(path) {
    size_ = std::filesystem::file_size(path);
    TiffDirectoryReader(*this).read_all(*this);
}

std::string TiffFile::bytes(std::uint64_t at, std::uint64_t count) const {
    return TiffDirectoryReader(*this).get(at, count);
}

std::vector<std::uint64_t> TiffFile::numbers(const TiffField& field) const {
    TiffDirectoryReader reader(*this);
    const std::string bytes = reader.values_of(field);
    std::vector<std::uint64_t> all;
    for (std::uint64_t i = 0; i < field.count; ++i)
        all.push_back(reader.whole(field, bytes, i));
    return all;
}

}  // namespace edgesplat::detail
