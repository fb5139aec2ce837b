#include <png.h>

#include <algorithm>
#include <cmath>
#include <csetjmp>
#include <cstdint>

#include "engine/error.h"
#include "engine/image/image_file.h"
#include "engine/image/srgb.h"

namespace edgesplat {
namespace {

/// 0..1 to 0..255, rounded; NaN and negative values become 0.
std::uint8_t to_byte(float value) {
    return value > 0 ? static_cast<std::uint8_t>(std::lround(std::min(value, 1.0F) * 255.0F)) : std::uint8_t{0};
}

bool is_ascii(const std::string& text) {
    return std::ranges::all_of(text, [](char c) { return static_cast<unsigned char>(c) < 0x80; });
}

/// libpng's state, freed in the destructor, also after an error: libpng reports errors by longjmp.
struct Writer {
    png_structp png = nullptr;
    png_infop info = nullptr;
    std::string bytes, problem;

    Writer() {
        png = png_create_write_struct(PNG_LIBPNG_VER_STRING, this, &failed, [](png_structp, png_const_charp) {});
        if (png != nullptr) info = png_create_info_struct(png);
    }
    ~Writer() { png_destroy_write_struct(&png, &info); }
    Writer(const Writer&) = delete;
    Writer& operator=(const Writer&) = delete;

    static void failed(png_structp png, png_const_charp message) {
        static_cast<Writer*>(png_get_error_ptr(png))->problem = message;
        png_longjmp(png, 1);
    }
    static void append(png_structp png, png_bytep data, std::size_t size) {
        static_cast<Writer*>(png_get_io_ptr(png))->bytes.append(reinterpret_cast<const char*>(data), size);
    }

    /// Returns whether encoding succeeded. No local variable here may have a destructor.
    bool write(int width, int height, int color_type, std::vector<png_text>& texts, png_bytep* rows) {
        if (setjmp(png_jmpbuf(png)) != 0) return false;
        png_set_write_fn(png, this, &append, nullptr);
        png_set_IHDR(png, info, static_cast<png_uint_32>(width), static_cast<png_uint_32>(height), 8, color_type,
                     PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
        png_set_compression_level(png, 3);  // a third of the default's time; files are 1 % longer
        png_set_sRGB_gAMA_and_cHRM(png, info, PNG_sRGB_INTENT_PERCEPTUAL);
        png_set_text(png, info, texts.data(), static_cast<int>(texts.size()));
        png_write_info(png, info);
        png_write_image(png, rows);
        png_write_end(png, nullptr);
        return true;
    }
};

/// Bytes of a PNG: sRGB-encoded, colour divided by alpha.
std::vector<std::uint8_t> bytes_of(const Image& image) {
    const bool has_alpha = image.channels == 2 || image.channels == 4;
    const auto channels = static_cast<std::size_t>(image.channels), colors = has_alpha ? channels - 1 : channels;
    std::vector<std::uint8_t> bytes(image.pixels.size());
    for (std::size_t pixel = 0; pixel < bytes.size(); pixel += channels) {
        const float alpha = has_alpha ? image.pixels[pixel + colors] : 1.0F;
        for (std::size_t c = 0; c < colors; ++c) {
            const float straight = alpha > 0 ? image.pixels[pixel + c] / alpha : 0.0F;
            bytes[pixel + c] = to_byte(to_srgb(straight));
        }
        if (has_alpha) bytes[pixel + colors] = to_byte(alpha);
    }
    return bytes;
}

}  // namespace

std::string encode_png(const Image& image, const ImageMetadata& metadata) {
    check_image(image);
    if (image.channels > 4) fail("a PNG has 1 to 4 channels, not {}", image.channels);
    constexpr int kTypes[] = {PNG_COLOR_TYPE_GRAY, PNG_COLOR_TYPE_GRAY_ALPHA, PNG_COLOR_TYPE_RGB, PNG_COLOR_TYPE_RGBA};
    std::vector<std::uint8_t> bytes = bytes_of(image);
    std::vector<png_bytep> rows;
    for (int y = 0; y < image.height; ++y)
        rows.push_back(bytes.data() + static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width) *
                                          static_cast<std::size_t>(image.channels));
    ImageMetadata strings = metadata;  // libpng takes non-const strings
    std::vector<png_text> texts;
    for (auto& [name, text] : strings) {
        png_text chunk{};
        chunk.compression = is_ascii(text) ? PNG_TEXT_COMPRESSION_NONE : PNG_ITXT_COMPRESSION_NONE;
        chunk.key = name.data();
        chunk.text = text.data();
        (chunk.compression == PNG_TEXT_COMPRESSION_NONE ? chunk.text_length : chunk.itxt_length) = text.size();
        texts.push_back(chunk);
    }
    Writer writer;
    if (writer.info == nullptr ||
        !writer.write(image.width, image.height, kTypes[image.channels - 1], texts, rows.data()))
        fail("cannot encode the picture as png: {}", writer.problem);
    return std::move(writer.bytes);
}

}  // namespace edgesplat
