// Decodes the data of VTK XML files: text, base64 or raw bytes, plain or in compressed blocks.
#include <lz4.h>
#include <lzma.h>
#include <zlib.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <limits>

#include "engine/volume/io/vtk_grid.h"
#include "engine/volume/io/vtk_xml.h"

namespace edgesplat::detail {

// The bytes of an array, taken in order. Writers encode the numbers before the data together with them or apart: a
// group of four characters with padding ends one part, and the next group begins another.
struct VtkXmlFile::Blob {
    std::string_view text;  // the rest
    bool base64 = false;
    std::array<std::byte, 3> spare{};
    std::size_t spares = 0;

    /// Whether there were enough bytes.
    bool take(std::byte* to, std::size_t count) {
        if (!base64) {
            if (count > text.size()) return false;
            std::copy_n(reinterpret_cast<const std::byte*>(text.data()), count, to);
            text.remove_prefix(count);
            return true;
        }
        while (count > 0) {
            if (spares == 0 && !next_group()) return false;
            const std::size_t part = std::min(count, spares);
            to = std::copy_n(spare.begin(), part, to);
            std::copy(spare.begin() + static_cast<std::ptrdiff_t>(part), spare.end(), spare.begin());
            spares -= part;
            count -= part;
        }
        return true;
    }

  private:
    bool next_group() {
        std::array<unsigned, 4> digits{};
        std::size_t padding = 0;
        for (unsigned& digit : digits) {
            while (!text.empty() &&
                   (text.front() == '\n' || text.front() == ' ' || text.front() == '\r' || text.front() == '\t'))
                text.remove_prefix(1);
            if (text.empty()) return false;
            const char c = text.front();
            text.remove_prefix(1);
            if (c == '=') {
                ++padding;
                continue;
            }
            if (padding > 0) return false;
            const bool plus = c == '+', slash = c == '/';
            if (c >= 'A' && c <= 'Z')
                digit = static_cast<unsigned>(c - 'A');
            else if (c >= 'a' && c <= 'z')
                digit = static_cast<unsigned>(c - 'a') + 26;
            else if (c >= '0' && c <= '9')
                digit = static_cast<unsigned>(c - '0') + 52;
            else if (plus || slash)
                digit = plus ? 62 : 63;
            else
                return false;
        }
        if (padding > 2) return false;
        const unsigned bits = digits[0] << 18 | digits[1] << 12 | digits[2] << 6 | digits[3];
        spare = {static_cast<std::byte>(bits >> 16), static_cast<std::byte>(bits >> 8), static_cast<std::byte>(bits)};
        spares = 3 - padding;
        return true;
    }
};

VtkXmlFile::VtkXmlFile(const std::string& path) : path_(path), file_(path) {
    std::string_view text = file_.bytes();
    // Appended data may be bytes of any kind, which are no XML.
    const auto begin = text.find("<AppendedData");
    has_appended_ = begin != std::string_view::npos;
    check_memory(path, "its XML text", 2 * std::min(begin, text.size()));
    pugi::xml_parse_result parsed;
    if (has_appended_) {
        std::string head(text.substr(0, begin));
        head += "</VTKFile>";
        parsed = document_.load_buffer(head.data(), head.size());
        const auto tag_end = std::min(text.find('>', begin), text.size());
        const auto tag = text.substr(begin, tag_end - begin);
        appended_is_base64_ = tag.find("base64") != std::string_view::npos;
        const auto underscore = text.find('_', tag_end);
        if (underscore == std::string_view::npos || underscore - tag_end > 4096)
            fail("{}: truncated: AppendedData without data", path);
        appended_ = text.substr(underscore + 1);
        if (appended_is_base64_) appended_ = appended_.substr(0, appended_.find('<'));
    } else {
        parsed = document_.load_buffer(text.data(), text.size());
    }
    if (!root())
        fail("{}: no VTK XML file: {} at byte {}", path, parsed ? "no element VTKFile" : parsed.description(),
             parsed.offset);
    if (!parsed) fail("{}: truncated or damaged: {} at byte {}", path, parsed.description(), parsed.offset);
    const std::string order = root().attribute("byte_order").as_string("LittleEndian");
    const std::string header = root().attribute("header_type").as_string("UInt32");
    const std::string compressor = root().attribute("compressor").as_string();
    if (order != "LittleEndian" && order != "BigEndian")
        fail("{}: byte_order '{}': expected LittleEndian or BigEndian", path, order);
    if (header != "UInt32" && header != "UInt64") fail("{}: header_type '{}': expected UInt32 or UInt64", path, header);
    big_endian_ = order == "BigEndian";
    word_ = header == "UInt32" ? 4 : 8;
    if (compressor == "vtkZLibDataCompressor")
        compressor_ = Compressor::Zlib;
    else if (compressor == "vtkLZ4DataCompressor")
        compressor_ = Compressor::Lz4;
    else if (compressor == "vtkLZMADataCompressor")
        compressor_ = Compressor::Lzma;
    else if (!compressor.empty())
        fail("{}: compressor '{}': expected vtkZLibDataCompressor, vtkLZ4DataCompressor or vtkLZMADataCompressor", path,
             compressor);
}

bool VtkXmlFile::swapped(const pugi::xml_node& array) const {
    return std::string_view(array.attribute("format").as_string("ascii")) != "ascii" &&
           big_endian_ != (std::endian::native == std::endian::big);
}

std::optional<SampleType> VtkXmlFile::type_of(const pugi::xml_node& array) {
    std::string name = array.attribute("type").as_string();
    if (name == "vtkIdType") name = "Int64";
    for (char& c : name)
        if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
    SampleType type{};
    return sample_type_named(name, type) ? std::optional(type) : std::nullopt;
}

std::size_t VtkXmlFile::ratio() const {
    switch (compressor_) {
        case Compressor::None:
            return kPlainRatio;
        case Compressor::Zlib:
        case Compressor::Lz4:
            return kBestDeflateRatio;
        case Compressor::Lzma:
            return kBestPictureRatio;
    }
    return kPlainRatio;
}

std::vector<std::byte> VtkXmlFile::samples(const pugi::xml_node& array, std::size_t count) const {
    const std::string what = fmt::format("array '{}'", array.attribute("Name").as_string());
    const auto type = type_of(array);
    if (!type)
        fail("{}: {} of type '{}' cannot be read; expected Int8 to UInt64, Float32 or Float64", path_, what,
             array.attribute("type").as_string());
    const std::string format = array.attribute("format").as_string("ascii");
    std::string_view text = array.text().get();
    if (format == "ascii") {
        auto found = vtk_text_samples(path_, what, *type, count, text);
        if (const auto more = next_vtk_word(text); !more.empty())
            fail("{}: {}: more than the {} numbers that its extent needs", path_, what, count);
        return found;
    }
    Blob blob{.text = text, .base64 = true, .spare = {}, .spares = 0};
    if (format == "appended") {
        std::int64_t offset = -1;
        const std::string given = array.attribute("offset").as_string();
        if (!has_appended_ || !vtk_number(given, offset) || offset < 0 ||
            static_cast<std::size_t>(offset) >= appended_.size())
            fail("{}: {}: offset '{}' does not lie in the {} bytes of appended data: truncated?", path_, what, given,
                 appended_.size());
        blob.text = appended_.substr(static_cast<std::size_t>(offset));
        blob.base64 = appended_is_base64_;
    } else if (format != "binary") {
        fail("{}: {}: format '{}': expected ascii, binary or appended", path_, what, format);
    }
    return unpacked(what, blob, count * size_of(*type));
}

std::vector<std::byte> VtkXmlFile::unpacked(const std::string& what, Blob& blob, std::size_t bytes) const {
    const auto word = [&] {
        std::array<std::byte, 8> raw{};
        if (!blob.take(raw.data(), word_)) fail("{}: {}: truncated or no base64 text", path_, what);
        std::uint64_t value = 0;
        for (std::size_t i = 0; i < word_; ++i)
            value = value << 8 | static_cast<std::uint64_t>(raw[big_endian_ ? i : word_ - 1 - i]);
        return value;
    };
    const auto check_size = [&](std::uint64_t found) {
        if (found != bytes) fail("{}: {}: {} bytes of data, but its extent needs {}", path_, what, found, bytes);
        check_stored_size(path_, bytes, blob.text.size(), ratio());
    };
    std::vector<std::byte> samples;
    if (compressor_ == Compressor::None) {
        check_size(word());
        samples.resize(bytes);
        if (!blob.take(samples.data(), bytes)) fail("{}: {}: truncated or no base64 text", path_, what);
        return samples;
    }
    const std::uint64_t blocks = word();
    if (blocks == 0) {
        check_size(0);
        return samples;
    }
    const std::uint64_t block = word(), last = word();
    std::uint64_t total = 0;
    if (blocks > blob.text.size() || __builtin_mul_overflow(blocks - (last > 0 ? 1 : 0), block, &total) ||
        __builtin_add_overflow(total, last, &total))
        fail("{}: {}: {} blocks of {} bytes, but there are only {} bytes of data", path_, what, blocks, block,
             blob.text.size());
    check_size(total);
    std::vector<std::uint64_t> sizes(blocks);
    for (std::uint64_t& size : sizes)
        size = word();
    // The blocks are encoded apart from the numbers before them.
    blob.spares = 0;
    samples.resize(bytes);
    std::vector<std::byte> packed;
    std::size_t at = 0;
    for (std::size_t i = 0; i < sizes.size(); ++i) {
        const std::size_t wanted = i + 1 == sizes.size() && last > 0 ? last : block;
        if (sizes[i] > blob.text.size() + 4)
            fail("{}: {}: truncated: block {} of {} with {} bytes, but {} are left", path_, what, i, sizes.size(),
                 sizes[i], blob.text.size());
        packed.resize(sizes[i]);
        if (!blob.take(packed.data(), packed.size()))
            fail("{}: {}: truncated or no base64 text in block {} of {}", path_, what, i, sizes.size());
        unpack_block(fmt::format("{}: block {} of {}", what, i, sizes.size()), packed, samples.data() + at, wanted);
        at += wanted;
    }
    return samples;
}

void VtkXmlFile::unpack_block(const std::string& what, const std::vector<std::byte>& packed, std::byte* to,
                              std::size_t bytes) const {
    constexpr auto kMost = static_cast<std::size_t>(std::numeric_limits<int>::max());
    bool well = false;
    if (compressor_ == Compressor::Zlib) {
        uLongf got = bytes;
        well = uncompress(reinterpret_cast<Bytef*>(to), &got, reinterpret_cast<const Bytef*>(packed.data()),
                          packed.size()) == Z_OK &&
               got == bytes;
    } else if (compressor_ == Compressor::Lz4) {
        well = bytes <= kMost && packed.size() <= kMost &&
               LZ4_decompress_safe(reinterpret_cast<const char*>(packed.data()), reinterpret_cast<char*>(to),
                                   static_cast<int>(packed.size()), static_cast<int>(bytes)) == static_cast<int>(bytes);
    } else {
        constexpr std::uint64_t kMemory = std::uint64_t{1} << 28;
        std::uint64_t memory = kMemory;
        std::size_t in = 0, out = 0;
        well = lzma_stream_buffer_decode(&memory, 0, nullptr, reinterpret_cast<const std::uint8_t*>(packed.data()), &in,
                                         packed.size(), reinterpret_cast<std::uint8_t*>(to), &out, bytes) == LZMA_OK &&
               out == bytes;
    }
    if (!well) fail("{}: {}: damaged compressed data", path_, what);
}

}  // namespace edgesplat::detail
