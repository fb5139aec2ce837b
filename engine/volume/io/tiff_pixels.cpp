// Unpacks the pixels of TIFF pages: libtiff decodes blocks, the samples are taken out of them here.
#include <algorithm>
#include <bit>
#include <cstring>

#include "engine/volume/io/half.h"
#include "engine/volume/io/readers.h"
#include "engine/volume/io/tiff_file.h"

namespace edgesplat::detail {
namespace {

enum : std::uint64_t { kUnsigned = 1, kSigned = 2, kFloat = 3, kVoid = 4 };

/// Blocks of a page, in pixels.
struct TiffBlocks {
    std::uint64_t width = 0, height = 0, across = 0, down = 0;
    std::uint64_t samples = 1;  ///< per pixel in a block
    std::uint64_t row_bytes = 0;
    bool is_tiled = false;

    std::uint64_t count() const { return across * down; }
};

TiffBlocks blocks_of(const TiffPlane& plane) {
    const TiffPage& page = plane.description();
    TiffBlocks blocks;
    blocks.is_tiled = page.tile_width > 0 || page.tile_height > 0;
    blocks.width = blocks.is_tiled ? page.tile_width : page.width;
    blocks.height = blocks.is_tiled ? page.tile_height : std::min(page.rows_per_strip, page.height);
    if (blocks.width == 0 || blocks.height == 0 || blocks.width > 1 << 24 || blocks.height > 1 << 24)
        fail("{}: blocks of {} x {} pixels", plane.name(), blocks.width, blocks.height);
    blocks.across = (page.width + blocks.width - 1) / blocks.width;
    blocks.down = (page.height + blocks.height - 1) / blocks.height;
    blocks.samples = page.planar == 2 ? 1 : page.samples;
    blocks.row_bytes = (blocks.width * blocks.samples * page.bits + 7) / 8;  // below 2^24 * 2^16 * 2^6
    return blocks;
}

/// `count` bits from bit `at` on, the most significant first.
std::uint32_t bits_at(const unsigned char* row, std::uint64_t at, std::uint64_t count) {
    std::uint32_t value = 0;
    for (std::uint64_t bit = at; bit < at + count;) {
        const std::uint64_t inside = bit % 8, taken = std::min(8 - inside, at + count - bit);
        const auto part = static_cast<std::uint32_t>((row[bit / 8] >> (8 - inside - taken)) & ((1 << taken) - 1));
        value = (value << taken) | part;
        bit += taken;
    }
    return value;
}

template <typename T>
void put(void* target, std::uint64_t index, T value) {
    std::memcpy(static_cast<unsigned char*>(target) + index * sizeof(T), &value, sizeof(T));
}

void put_whole(void* target, std::uint64_t index, std::uint64_t bytes, std::uint32_t value) {
    if (bytes == 1) return put(target, index, static_cast<std::uint8_t>(value));
    if (bytes == 2) return put(target, index, static_cast<std::uint16_t>(value));
    put(target, index, value);
}

/// Takes samples `first`, first + samples, ... of a decoded row.
void take_row(const TiffPage& page, const unsigned char* row, std::uint64_t first, std::uint64_t samples,
              std::uint64_t count, void* target) {
    const std::uint64_t bits = page.bits;
    const auto sample = [&](std::uint64_t i) { return first + i * samples; };
    if (page.format == kFloat && bits == 16) {
        for (std::uint64_t i = 0; i < count; ++i) {
            std::uint16_t half = 0;
            std::memcpy(&half, row + 2 * sample(i), 2);
            put(target, i, float_of_half(half));
        }
    } else if (bits == 24) {
        for (std::uint64_t i = 0; i < count; ++i) {
            const unsigned char* at = row + 3 * sample(i);  // libtiff swaps triples, too
            constexpr bool kLittle = std::endian::native == std::endian::little;
            const std::uint32_t value = (std::uint32_t{at[kLittle ? 2 : 0]} << 16) | (std::uint32_t{at[1]} << 8) |
                                        std::uint32_t{at[kLittle ? 0 : 2]};
            if (page.format == kFloat)
                put(target, i, small_float(value, 7, 16));  // Adobe's float of 24 bits
            else
                put(target, i, page.format == kSigned && (value >> 23) != 0 ? value | 0xFF000000U : value);
        }
    } else if (bits % 8 == 0) {
        const std::uint64_t bytes = bits / 8;
        auto* out = static_cast<unsigned char*>(target);
        if (samples == 1)
            std::memcpy(out, row, count * bytes);
        else
            for (std::uint64_t i = 0; i < count; ++i)
                std::memcpy(out + i * bytes, row + bytes * sample(i), bytes);
    } else {
        const std::uint64_t bytes = bits <= 8 ? 1 : bits <= 16 ? 2 : 4;
        for (std::uint64_t i = 0; i < count; ++i) {
            std::uint32_t value = bits_at(row, sample(i) * bits, bits);
            if (page.format == kSigned && (value >> (bits - 1)) != 0) value |= ~std::uint32_t{0} << bits;
            put_whole(target, i, bytes, value);
        }
    }
}

template <typename T>
void mirror_values(void* target, std::uint64_t count, T largest) {
    for (std::uint64_t i = 0; i < count; ++i) {
        T value;
        std::memcpy(&value, static_cast<unsigned char*>(target) + i * sizeof(T), sizeof(T));
        put(target, i, static_cast<T>(largest - value));
    }
}

void undo_minimum_is_white(const TiffPage& page, void* target, std::uint64_t count) {
    if (page.photometric != 0 || (page.format != kUnsigned && page.format != kVoid)) return;
    const std::uint64_t largest = page.bits >= 64 ? ~std::uint64_t{0} : (std::uint64_t{1} << page.bits) - 1;
    if (page.bits <= 8) return mirror_values(target, count, static_cast<std::uint8_t>(largest));
    if (page.bits <= 16) return mirror_values(target, count, static_cast<std::uint16_t>(largest));
    if (page.bits <= 32) return mirror_values(target, count, static_cast<std::uint32_t>(largest));
    mirror_values(target, count, largest);
}

}  // namespace

SampleType tiff_sample_type(const TiffFile& file, const TiffPage& page) {
    if (page.is_mixed)
        fail("{}: its samples differ in BitsPerSample or SampleFormat; expected the same for all", file.path());
    const auto refused = [&]() {
        fail(
            "{}: samples of {} bits, SampleFormat {}: expected whole numbers of 1 to 32 or of 64 bits, or floats of "
            "16, 24, 32 or 64",
            file.path(), page.bits, page.format);
    };
    if (page.format == kFloat) {
        if (page.bits == 64) return SampleType::Float64;
        if (page.bits != 16 && page.bits != 24 && page.bits != 32) refused();
        return SampleType::Float32;
    }
    const bool is_signed = page.format == kSigned;
    if (!is_signed && page.format != kUnsigned && page.format != kVoid) refused();
    if (page.bits == 64) return is_signed ? SampleType::Int64 : SampleType::UInt64;
    if (page.bits < 1 || page.bits > 32) refused();
    if (page.bits <= 8) return is_signed ? SampleType::Int8 : SampleType::UInt8;
    if (page.bits <= 16) return is_signed ? SampleType::Int16 : SampleType::UInt16;
    return is_signed ? SampleType::Int32 : SampleType::UInt32;
}

std::string TiffPlane::name() const {
    return fmt::format("page {} of {}", page, file->path());
}

void TiffPixels::read(const TiffPlane& plane, std::size_t sample, void* target) {
    const TiffPage& page = plane.description();
    const std::uint64_t bytes_out = size_of(tiff_sample_type(*plane.file, page));
    auto* out = static_cast<unsigned char*>(target);
    if (plane.raw_at) {
        const std::uint64_t row_bytes = (page.width * page.samples * page.bits + 7) / 8;
        block_ = plane.file->bytes(*plane.raw_at, row_bytes * page.height);
        const std::uint64_t word = page.bits / 8;
        if (plane.file->is_swapped() && page.bits % 8 == 0 && word > 1)
            for (std::size_t at = 0; at + word <= block_.size(); at += word)
                std::reverse(block_.begin() + static_cast<std::ptrdiff_t>(at),
                             block_.begin() + static_cast<std::ptrdiff_t>(at + word));
        for (std::uint64_t y = 0; y < page.height; ++y)
            take_row(page, reinterpret_cast<const unsigned char*>(block_.data()) + y * row_bytes, sample, page.samples,
                     page.width, out + y * page.width * bytes_out);
        return undo_minimum_is_white(page, target, page.width * page.height);
    }
    const TiffBlocks blocks = blocks_of(plane);
    const std::uint64_t wanted = blocks.count() * (page.planar == 2 ? page.samples : 1);
    if (page.offsets.count != wanted)
        fail("{}: {} strips or tiles, expected {} for {} x {} pixels", plane.name(), page.offsets.count, wanted,
             page.width, page.height);
    const std::uint64_t block_bytes = blocks.row_bytes * blocks.height;
    // A tile may be larger than the picture, but not than what its bytes can unpack to.
    check_memory(plane.file->path(), fmt::format("strips or tiles of {} x {} pixels", blocks.width, blocks.height),
                 block_bytes);
    check_stored_size(plane.file->path(), block_bytes, plane.file->size(),
                      page.compression == 1 ? kPlainRatio : kBestPictureRatio);
    std::vector<std::uint64_t> offsets, counts;
    if (page.has_missing) {
        offsets = plane.file->numbers(page.offsets);
        counts = plane.file->numbers(page.counts);
    }
    if (!decoder_ || open_path_ != plane.file->path()) {
        std::string reason;
        decoder_ = codec_library().open_tiff(plane.file->path(), reason);
        open_path_ = plane.file->path();
        if (!decoder_) fail("{}: cannot be read: {}", open_path_, reason);
    }
    const std::uint64_t first = page.planar == 2 ? 0 : sample;
    for (std::uint64_t i = 0; i < blocks.count(); ++i) {
        const std::uint64_t x = i % blocks.across * blocks.width, y = i / blocks.across * blocks.height;
        const std::uint64_t columns = std::min(blocks.width, page.width - x);
        const std::uint64_t rows = std::min(blocks.height, page.height - y);
        const std::uint64_t coded_rows = blocks.is_tiled ? blocks.height : rows;
        const std::uint64_t index = i + (page.planar == 2 ? sample * blocks.count() : 0);
        block_.assign(static_cast<std::size_t>(blocks.row_bytes * coded_rows), '\0');
        if (!page.has_missing || offsets[index] != 0 || counts[index] != 0) {
            const std::string reason =
                decoder_->decode(page.directory, static_cast<std::uint32_t>(index),
                                 static_cast<std::uint32_t>(coded_rows), block_.data(), block_.size());
            if (!reason.empty()) fail("{}: truncated or damaged: {}", plane.name(), tidy(reason));
        }
        for (std::uint64_t row = 0; row < rows; ++row)
            take_row(page, reinterpret_cast<const unsigned char*>(block_.data()) + row * blocks.row_bytes, first,
                     blocks.samples, columns, out + ((y + row) * page.width + x) * bytes_out);
    }
    undo_minimum_is_white(page, target, page.width * page.height);
}

}  // namespace edgesplat::detail
