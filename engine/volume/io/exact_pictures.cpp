#include "engine/volume/io/exact_pictures.h"

#include <png.h>

#include <algorithm>
#include <bit>
#include <csetjmp>
#include <cstring>
#include <fstream>

#include "engine/volume/io/readers.h"

namespace edgesplat::detail {
namespace {

/// Decoded pages of one size.
class DecodedPicture : public PictureReader {
  public:
    DecodedPicture(const PicturePage& page, std::vector<std::string> pages) : page_(page), pages_(std::move(pages)) {}
    bool seek(int page) override { return page >= 0 && static_cast<std::size_t>(page) < pages_.size(); }
    PicturePage page() const override { return page_; }
    bool read(int page, SampleType type, void* samples) override {
        if (!seek(page) || type != *page_.type) return false;
        const std::string& bytes = pages_[static_cast<std::size_t>(page)];
        std::memcpy(samples, bytes.data(), bytes.size());
        return true;
    }
    std::string take_error() override { return {}; }

  private:
    PicturePage page_;
    std::vector<std::string> pages_;
};

PicturePage decoded_page(const std::string& path, std::size_t width, std::size_t height, int channels, SampleType type,
                         bool is_palette = false) {
    checked_bytes(path, {width, height, 1}, static_cast<std::size_t>(channels) * size_of(type));
    PicturePage page{.width = static_cast<int>(width),
                     .height = static_cast<int>(height),
                     .depth = 1,
                     .channels = channels,
                     .type = type,
                     .type_name = std::string(name_of(type)),
                     .channel_names = {},
                     .texts = {}};
    if (is_palette) page.texts.emplace_back("palette", "");
    return page;
}

std::string picture_bytes(const std::string& path) {
    const std::size_t size = std::filesystem::file_size(path);
    check_memory(path, "the file", size);
    std::ifstream in(path, std::ios::binary);
    std::string bytes(size, '\0');
    in.read(bytes.data(), static_cast<std::streamsize>(size));
    if (!in) fail("{}: cannot be read", path);
    return bytes;
}

// --- PNG ---

/// libpng's state, freed in the destructor, also after an error: libpng reports errors by longjmp.
struct PngReader {
    png_structp png = nullptr;
    png_infop info = nullptr;
    std::string_view bytes;
    std::string problem;

    explicit PngReader(std::string_view of) : bytes(of) {
        png = png_create_read_struct(PNG_LIBPNG_VER_STRING, this, &failed, [](png_structp, png_const_charp) {});
        if (png != nullptr) info = png_create_info_struct(png);
    }
    ~PngReader() { png_destroy_read_struct(&png, &info, nullptr); }
    PngReader(const PngReader&) = delete;
    PngReader& operator=(const PngReader&) = delete;

    static void failed(png_structp png, png_const_charp message) {
        static_cast<PngReader*>(png_get_error_ptr(png))->problem = message;
        png_longjmp(png, 1);
    }
    static void give(png_structp png, png_bytep target, std::size_t size) {
        auto& rest = static_cast<PngReader*>(png_get_io_ptr(png))->bytes;
        if (size > rest.size()) png_error(png, "truncated");
        std::memcpy(target, rest.data(), size);
        rest.remove_prefix(size);
    }

    /// Both return whether they succeeded. No local variable here may have a destructor.
    bool read_header() {
        if (setjmp(png_jmpbuf(png)) != 0) return false;
        png_set_read_fn(png, this, &give);
        png_read_info(png, info);
        png_set_packing(png);  // fewer than 8 bits: a byte each, not scaled
        if (std::endian::native == std::endian::little && png_get_bit_depth(png, info) == 16) png_set_swap(png);
        (void)png_set_interlace_handling(png);
        png_read_update_info(png, info);
        return true;
    }
    bool read_rows(png_bytepp rows) {
        if (setjmp(png_jmpbuf(png)) != 0) return false;
        png_read_image(png, rows);
        png_read_end(png, nullptr);
        return true;
    }
};

std::unique_ptr<PictureReader> open_png(const std::string& path, std::string_view bytes) {
    PngReader reader(bytes);
    if (reader.info == nullptr || !reader.read_header())
        fail("{}: truncated or damaged: {}", path, tidy(reader.problem));
    const std::size_t width = png_get_image_width(reader.png, reader.info);
    const std::size_t height = png_get_image_height(reader.png, reader.info);
    const int channels = png_get_channels(reader.png, reader.info);
    const bool wide = png_get_bit_depth(reader.png, reader.info) == 16;
    const PicturePage page = decoded_page(path, width, height, channels, wide ? SampleType::UInt16 : SampleType::UInt8,
                                          png_get_color_type(reader.png, reader.info) == PNG_COLOR_TYPE_PALETTE);
    const std::size_t row = png_get_rowbytes(reader.png, reader.info);
    if (row != width * static_cast<std::size_t>(channels) * (wide ? 2 : 1))
        fail("{}: rows of {} bytes, expected whole samples", path, row);
    check_stored_size(path, row * height, bytes.size(), kBestDeflateRatio * 8);
    std::string pixels(row * height, '\0');
    std::vector<png_bytep> rows;
    for (std::size_t y = 0; y < height; ++y)
        rows.push_back(reinterpret_cast<png_bytep>(pixels.data() + y * row));
    if (!reader.read_rows(rows.data())) fail("{}: truncated or damaged: {}", path, tidy(reader.problem));
    return std::make_unique<DecodedPicture>(page, std::vector{std::move(pixels)});
}

// --- Portable grey and colour maps ---

std::unique_ptr<PictureReader> open_portable_map(const std::string& path, std::string_view bytes) {
    const char kind = bytes[1];
    std::size_t at = 2;
    const auto is_blank = [](char c) {
        return c == ' ' || c == '\t' || c == '\n' || c == '\r' || c == '\v' || c == '\f';
    };
    const auto number = [&]() -> std::size_t {
        while (at < bytes.size() && (is_blank(bytes[at]) || bytes[at] == '#')) {
            if (bytes[at] == '#')
                while (at < bytes.size() && bytes[at] != '\n')
                    ++at;
            else
                ++at;
        }
        std::size_t value = 0;
        const std::size_t begin = at;
        for (; at < bytes.size() && bytes[at] >= '0' && bytes[at] <= '9' && value < 100000000; ++at)
            value = 10 * value + static_cast<std::size_t>(bytes[at] - '0');
        if (at == begin) fail("{}: truncated or damaged: expected a number at byte {}", path, at);
        return value;
    };
    const std::size_t width = number(), height = number(), largest = number();
    if (largest < 1 || largest > 65535) fail("{}: its largest value is {}, expected 1 to 65535", path, largest);
    const int channels = kind == '3' || kind == '6' ? 3 : 1;
    const bool wide = largest > 255, is_text = kind == '2' || kind == '3';
    const PicturePage page = decoded_page(path, width, height, channels, wide ? SampleType::UInt16 : SampleType::UInt8);
    const std::size_t count = width * height * static_cast<std::size_t>(channels);
    check_stored_size(path, count, bytes.size(), 1);
    std::string pixels(count * (wide ? 2 : 1), '\0');
    const auto put = [&](std::size_t i, std::size_t value) {
        if (value > largest) fail("{}: a value of {}, expected at most {}", path, value, largest);
        const auto two = static_cast<std::uint16_t>(value);
        if (wide)
            std::memcpy(pixels.data() + 2 * i, &two, 2);
        else
            pixels[i] = static_cast<char>(value);
    };
    if (is_text) {
        for (std::size_t i = 0; i < count; ++i)
            put(i, number());
    } else {
        ++at;  // one blank before the samples
        if (at > bytes.size() || pixels.size() > bytes.size() - at)
            fail("{}: truncated: {} bytes of samples, expected {}", path, bytes.size() - std::min(at, bytes.size()),
                 pixels.size());
        const auto* in = reinterpret_cast<const unsigned char*>(bytes.data()) + at;
        for (std::size_t i = 0; i < count; ++i)
            put(i, wide ? std::size_t{in[2 * i]} << 8 | in[2 * i + 1] : in[i]);
    }
    return std::make_unique<DecodedPicture>(page, std::vector{std::move(pixels)});
}

// --- BMP with a palette ---

template <typename T>
T bmp_number(std::string_view bytes, std::size_t at) {
    T value = 0;
    for (std::size_t i = sizeof(T); i-- > 0;)
        value = static_cast<T>(value << 8 | static_cast<unsigned char>(bytes[at + i]));
    return value;
}

std::unique_ptr<PictureReader> open_bmp(const std::string& path, std::string_view bytes) {
    if (bytes.size() < 54 || bmp_number<std::uint32_t>(bytes, 14) < 40) return nullptr;
    const auto bits = bmp_number<std::uint16_t>(bytes, 28);
    if (bits != 1 && bits != 4 && bits != 8) return nullptr;
    if (bmp_number<std::uint32_t>(bytes, 30) != 0)
        fail("{}: a BMP whose palette indices are compressed is not read; save it as PNG", path);
    const auto width = static_cast<std::int32_t>(bmp_number<std::uint32_t>(bytes, 18));
    const auto height = static_cast<std::int32_t>(bmp_number<std::uint32_t>(bytes, 22));
    if (width < 1 || height == 0 || height == INT32_MIN) fail("{}: {} x {} pixels", path, width, height);
    const auto columns = static_cast<std::size_t>(width), rows = static_cast<std::size_t>(std::abs(height));
    const PicturePage page = decoded_page(path, columns, rows, 1, SampleType::UInt8, true);
    const std::size_t first = bmp_number<std::uint32_t>(bytes, 10), stride = (columns * bits + 31) / 32 * 4;
    if (first > bytes.size() || stride * rows > bytes.size() - first)
        fail("{}: truncated: {} rows of {} bytes after byte {}, but the file has {}", path, rows, stride, first,
             bytes.size());
    std::string pixels(columns * rows, '\0');
    for (std::size_t y = 0; y < rows; ++y) {
        const std::size_t from = first + stride * (height > 0 ? rows - 1 - y : y);  // the lowest row first
        for (std::size_t x = 0; x < columns; ++x) {
            const auto byte = static_cast<unsigned char>(bytes[from + x * bits / 8]);
            pixels[y * columns + x] = static_cast<char>(byte >> (8 - bits - x * bits % 8) & ((1 << bits) - 1));
        }
    }
    return std::make_unique<DecodedPicture>(page, std::vector{std::move(pixels)});
}

// --- GIF ---

class GifReader {
  public:
    GifReader(const std::string& path, std::string_view bytes) : path_(path), bytes_(bytes) {}

    std::unique_ptr<PictureReader> read() {
        at_ = 6;
        const std::size_t width = word(), height = word();
        const int flags = byte();
        skip(2);
        if ((flags & 0x80) != 0) skip(std::size_t{3} << ((flags & 7) + 1));
        const PicturePage page = decoded_page(path_, width, height, 1, SampleType::UInt8, true);
        std::vector<std::string> pages;
        std::size_t total = 0;
        while (true) {
            const int kind = byte();
            if (kind == 0x3B) break;
            if (kind == 0x21) {  // an extension
                skip(1);
                (void)blocks();
                continue;
            }
            if (kind != 0x2C) fail("{}: truncated or damaged: a block of kind {}", path_, kind);
            const std::size_t left = word(), top = word(), columns = word(), rows = word();
            const int local = byte();
            if (left != 0 || top != 0 || columns != width || rows != height)
                fail("{}: image {} covers a part of {} x {} pixels only; expected whole images", path_, pages.size(),
                     columns, rows);
            if ((local & 0x80) != 0) skip(std::size_t{3} << ((local & 7) + 1));
            check_memory(path_, "its images", total += width * height);
            const int code_bits = byte();
            std::string pixels = decoded(blocks(), code_bits, width * height);
            pages.push_back((local & 0x40) != 0 ? deinterlaced(pixels, width, height) : pixels);
        }
        if (pages.empty()) fail("{}: a GIF without images", path_);
        return std::make_unique<DecodedPicture>(page, std::move(pages));
    }

  private:
    int byte() {
        if (at_ >= bytes_.size()) fail("{}: truncated at byte {}", path_, bytes_.size());
        // cppcheck-suppress containerOutOfBounds; fail() does not return
        return static_cast<unsigned char>(bytes_[at_++]);
    }
    std::size_t word() {
        const int low = byte();
        return static_cast<std::size_t>(low | byte() << 8);
    }
    void skip(std::size_t count) {
        if (count > bytes_.size() - at_) fail("{}: truncated at byte {}", path_, bytes_.size());
        at_ += count;
    }
    std::string blocks() {
        std::string all;
        while (const int size = byte()) {
            const std::size_t begin = at_;
            skip(static_cast<std::size_t>(size));
            all.append(bytes_.substr(begin, static_cast<std::size_t>(size)));
        }
        return all;
    }

    /// LZW: codes of growing length, the least significant bit first.
    std::string decoded(const std::string& data, int first_bits, std::size_t count) const {
        if (first_bits < 1 || first_bits > 8) fail("{}: LZW codes of {} bits, expected 1 to 8", path_, first_bits);
        const unsigned clear = 1U << first_bits, end = clear + 1;
        struct Entry {
            std::uint16_t before;
            unsigned char last, first;
        };
        std::vector<Entry> table(4096);
        for (unsigned i = 0; i < clear; ++i)
            table[i] = {0, static_cast<unsigned char>(i), static_cast<unsigned char>(i)};
        std::vector<std::size_t> lengths(4096, 1);
        unsigned next = end + 1, bits = static_cast<unsigned>(first_bits) + 1, previous = clear;
        std::string out;
        out.reserve(count);
        std::uint32_t held = 0;
        unsigned held_bits = 0;
        std::size_t at = 0;
        while (out.size() < count) {
            while (held_bits < bits && at < data.size()) {
                held |= static_cast<std::uint32_t>(static_cast<unsigned char>(data[at++])) << held_bits;
                held_bits += 8;
            }
            if (held_bits < bits) break;
            const unsigned code = held & ((1U << bits) - 1);
            held >>= bits;
            held_bits -= bits;
            if (code == clear) {
                next = end + 1;
                bits = static_cast<unsigned>(first_bits) + 1;
                previous = clear;
                continue;
            }
            if (code == end) break;
            if (code > next || (code == next && previous == clear) || (previous == clear && code > clear))
                fail("{}: truncated or damaged: an LZW code of {}", path_, code);
            const bool is_new = code == next;
            if (previous != clear && next < 4096) {
                table[next] = {static_cast<std::uint16_t>(previous), table[is_new ? previous : code].first,
                               table[previous].first};
                lengths[next] = lengths[previous] + 1;
                ++next;
                if (next == 1U << bits && bits < 12) ++bits;
            } else if (is_new) {
                fail("{}: truncated or damaged: an LZW code of {}", path_, code);
            }
            const std::size_t length = lengths[code], begin = out.size();
            out.resize(begin + length);
            unsigned walk = code;
            for (std::size_t i = length; i-- > 0;) {
                out[begin + i] = static_cast<char>(table[walk].last);
                walk = table[walk].before;
            }
            previous = code;
        }
        if (out.size() < count) fail("{}: truncated or damaged: {} pixels, expected {}", path_, out.size(), count);
        out.resize(count);
        return out;
    }

    static std::string deinterlaced(const std::string& pixels, std::size_t width, std::size_t height) {
        std::string out(pixels.size(), '\0');
        std::size_t from = 0;
        constexpr std::size_t kPasses[][2] = {{0, 8}, {4, 8}, {2, 4}, {1, 2}};
        for (const auto& [begin, step] : kPasses)
            for (std::size_t y = begin; y < height; y += step, from += width)
                out.replace(y * width, width, pixels, from, width);
        return out;
    }

    const std::string& path_;
    std::string_view bytes_;
    std::size_t at_ = 0;
};

}  // namespace

bool begins_as_exact_picture(std::string_view head) {
    const bool is_map = head.size() > 2 && head[0] == 'P' && std::string_view("2356").find(head[1]) < 4 &&
                        std::string_view(" \t\r\n#").find(head[2]) < 5;
    return is_map || head.starts_with("\x89PNG\r\n\x1a\n") || head.starts_with("BM") || head.starts_with("GIF87a") ||
           head.starts_with("GIF89a");
}

std::unique_ptr<PictureReader> open_exact_picture(const std::string& path) {
    std::string head(8, '\0');
    std::ifstream in(path, std::ios::binary);
    in.read(head.data(), 8);
    if (!in || !begins_as_exact_picture(head)) return nullptr;
    if (head[0] == '\x89') return open_png(path, picture_bytes(path));
    if (head[0] == 'P') return open_portable_map(path, picture_bytes(path));
    if (head.starts_with("BM")) return open_bmp(path, picture_bytes(path));
    const std::string bytes = picture_bytes(path);
    return GifReader(path, bytes).read();
}

}  // namespace edgesplat::detail
