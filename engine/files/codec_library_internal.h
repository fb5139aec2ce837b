// Interface to libtiff, GDCM, blosc, zstd and lz4, which are in a separate module: they depend on 22 shared libraries,
// which every start of a program would load. The module is loaded when a file needs it.
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

/// How the pixels of a DICOM frame are stored.
struct DicomPixelFormat {
    std::size_t columns = 0, rows = 0, samples = 1;
    int bits_allocated = 16, bits_stored = 16, high_bit = 15;
    bool is_signed = false, planar = false;
    std::string photometric;
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
    /// Decodes the fragment `coded` of a frame in a transfer syntax; `format` becomes that of `out`, little-endian.
    /// Returns the reason of a failure, or "".
    virtual std::string decode_dicom(const std::string& transfer_syntax, std::string_view coded,
                                     DicomPixelFormat& format, std::string& out) const = 0;
    /// Unpacks exactly `bytes` bytes. Returns the reason of a failure, or "".
    virtual std::string unpack(Codec codec, std::string_view packed, void* target, std::size_t bytes) const = 0;
};

/// The module, loaded at the first call. Throws Error if it cannot be loaded.
const CodecLibrary& codec_library();

/// Name of the function that the module exports: `const CodecLibrary* edgesplat_codec_library()`.
inline constexpr const char* kCodecLibraryEntry = "edgesplat_codec_library";

}  // namespace edgesplat
