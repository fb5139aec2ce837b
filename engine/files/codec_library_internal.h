// Interface to libtiff, blosc, zstd and lz4, which are in a separate module: they depend on ten shared libraries, which
// every start of a program would load. The module is loaded when a file needs it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>

namespace edgesplat {

/// Decodes the blocks (strips or tiles) of an open TIFF file.
class TiffDecoder {
  public:
    TiffDecoder() = default;
    TiffDecoder(const TiffDecoder&) = delete;
    TiffDecoder& operator=(const TiffDecoder&) = delete;
    virtual ~TiffDecoder() = default;
    /// Decodes a block of the page whose directory lies at `directory`. `rows`: the block's rows of pixels; `bytes`:
    /// size of `target`, which must be the block's. Samples get this machine's byte order, YCbCr from JPEG becomes RGB.
    /// Returns the reason of a failure, or "".
    virtual std::string decode(std::uint64_t directory, std::uint32_t block, std::uint32_t rows, void* target,
                               std::size_t bytes) = 0;
};

enum class Codec { Blosc, Zstd, Lz4 };

class CodecLibrary {
  public:
    CodecLibrary() = default;
    CodecLibrary(const CodecLibrary&) = delete;
    CodecLibrary& operator=(const CodecLibrary&) = delete;
    virtual ~CodecLibrary() = default;
    /// Null if the file cannot be opened; `reason` then holds the cause.
    virtual std::unique_ptr<TiffDecoder> open_tiff(const std::string& path, std::string& reason) const = 0;
    /// Unpacks exactly `bytes` bytes. Returns the reason of a failure, or "".
    virtual std::string unpack(Codec codec, std::string_view packed, void* target, std::size_t bytes) const = 0;
};

/// The module, loaded at the first call. Throws Error if it cannot be loaded.
const CodecLibrary& codec_library();

/// Name of the function that the module exports: `const CodecLibrary* edgesplat_codec_library()`.
inline constexpr const char* kCodecLibraryEntry = "edgesplat_codec_library";

}  // namespace edgesplat
