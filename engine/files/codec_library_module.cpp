// The module of libtiff, GDCM, blosc, zstd and lz4 (engine/files/codec_library_internal.h).
#include <blosc.h>
#include <gdcmFragment.h>
#include <gdcmImage.h>
#include <gdcmSequenceOfFragments.h>
#include <lz4.h>
#include <tiffio.h>
#include <zstd.h>

#include <algorithm>
#include <array>
#include <cstdarg>
#include <cstdio>
#include <cstring>
#include <limits>
#include <utility>

#include "engine/files/codec_library_internal.h"

namespace edgesplat {
namespace {

class Decoder : public TiffDecoder {
  public:
    explicit Decoder(const std::string& path) {
        TIFFOpenOptions* options = TIFFOpenOptionsAlloc();
        TIFFOpenOptionsSetErrorHandlerExtR(options, &keep_first_error, this);
        TIFFOpenOptionsSetWarningHandlerExtR(options, &ignore, nullptr);
        // Directories have been checked before; this bounds what compressed data ask for.
        TIFFOpenOptionsSetMaxSingleMemAlloc(options, tmsize_t{1} << 34);
        // h: the first directory is not read here. m: not mapped, so that a file that shrinks is an error. c: strips as
        // the file has them, not cut into smaller ones.
        tiff_ = TIFFOpenExt(path.c_str(), "rhmc", options);
        TIFFOpenOptionsFree(options);
    }
    ~Decoder() override {
        if (tiff_ != nullptr) TIFFClose(tiff_);
    }
    Decoder(const Decoder&) = delete;
    Decoder& operator=(const Decoder&) = delete;

    bool is_open() const { return tiff_ != nullptr; }
    std::string take_reason(const char* otherwise) {
        return problem_.empty() ? otherwise : std::exchange(problem_, std::string());
    }

    std::string decode(std::uint64_t directory, std::uint32_t block, std::uint32_t rows, void* target,
                       std::size_t bytes) override {
        problem_.clear();
        if (directory != directory_) {
            directory_ = 0;
            if (TIFFSetSubDirectory(tiff_, directory) == 0) return take_reason("its directory cannot be read");
            std::uint16_t compression = COMPRESSION_NONE, photometric = PHOTOMETRIC_MINISBLACK;
            TIFFGetFieldDefaulted(tiff_, TIFFTAG_COMPRESSION, &compression);
            TIFFGetField(tiff_, TIFFTAG_PHOTOMETRIC, &photometric);
            if (TIFFIsCODECConfigured(compression) == 0)
                return "its compression, number " + std::to_string(compression) + ", is not one that libtiff reads";
            if (compression == COMPRESSION_JPEG && photometric == PHOTOMETRIC_YCBCR)
                TIFFSetField(tiff_, TIFFTAG_JPEGCOLORMODE, JPEGCOLORMODE_RGB);
            directory_ = directory;
        }
        const bool tiled = TIFFIsTiled(tiff_) != 0;
        const std::uint64_t size = tiled ? TIFFTileSize64(tiff_) : TIFFVStripSize64(tiff_, rows);
        if (size != bytes)
            return take_reason("its pixels are subsampled or packed in a way that is not read; expected whole pixels");
        const auto wanted = static_cast<tmsize_t>(bytes);
        const tmsize_t got = tiled ? TIFFReadEncodedTile(tiff_, block, target, wanted)
                                   : TIFFReadEncodedStrip(tiff_, block, target, wanted);
        // An error is also one if it was passed over: the block would be incomplete.
        if (got != wanted || !problem_.empty()) return take_reason("its data end too early");
        return {};
    }

  private:
    static int keep_first_error(TIFF*, void* self, const char*, const char* format, va_list arguments) {
        std::array<char, 400> text{};
        std::vsnprintf(text.data(), text.size(), format, arguments);
        auto& problem = static_cast<Decoder*>(self)->problem_;
        if (problem.empty()) problem = text.data();
        return 1;
    }
    static int ignore(TIFF*, void*, const char*, const char*, va_list) { return 1; }

    TIFF* tiff_ = nullptr;
    std::uint64_t directory_ = 0;
    std::string problem_;
};

std::string unpack_blosc(std::string_view packed, void* target, std::size_t bytes) {
    std::size_t size = 0;
    if (blosc_cbuffer_validate(packed.data(), packed.size(), &size) != 0) return "not a whole blosc buffer";
    if (size != bytes) return "blosc data of " + std::to_string(size) + " bytes, expected " + std::to_string(bytes);
    const int got = blosc_decompress_ctx(packed.data(), target, bytes, 1);
    if (got < 0 || static_cast<std::size_t>(got) != bytes) return "damaged blosc data";
    return {};
}

std::string unpack_zstd(std::string_view packed, void* target, std::size_t bytes) {
    const std::size_t got = ZSTD_decompress(target, bytes, packed.data(), packed.size());
    if (ZSTD_isError(got) != 0) return std::string("zstd: ") + ZSTD_getErrorName(got);
    if (got != bytes) return "zstd data of " + std::to_string(got) + " bytes, expected " + std::to_string(bytes);
    return {};
}

// numcodecs: the unpacked size in 4 bytes, little-endian, then one block.
std::string unpack_lz4(std::string_view packed, void* target, std::size_t bytes) {
    constexpr std::size_t kMost = std::numeric_limits<int>::max();
    if (packed.size() < 4 || packed.size() > kMost || bytes > kMost) return "not a whole lz4 buffer";
    const int got = LZ4_decompress_safe(packed.data() + 4, static_cast<char*>(target),
                                        static_cast<int>(packed.size() - 4), static_cast<int>(bytes));
    if (got < 0 || static_cast<std::size_t>(got) != bytes) return "damaged lz4 data";
    return {};
}

/// GDCM decodes from the fragment alone: it sees no header.
std::string decode_dicom_frame(const std::string& transfer_syntax, std::string_view coded, DicomPixelFormat& format,
                               std::string& out) {
    gdcm::Image image;
    image.SetNumberOfDimensions(2);
    image.SetDimension(0, static_cast<unsigned>(format.columns));
    image.SetDimension(1, static_cast<unsigned>(format.rows));
    image.SetTransferSyntax(gdcm::TransferSyntax::GetTSType(transfer_syntax.c_str()));
    image.SetPixelFormat(gdcm::PixelFormat(static_cast<unsigned short>(format.samples),
                                           static_cast<unsigned short>(format.bits_allocated),
                                           static_cast<unsigned short>(format.bits_stored),
                                           static_cast<unsigned short>(format.high_bit), format.is_signed ? 1 : 0));
    image.SetPhotometricInterpretation(gdcm::PhotometricInterpretation::GetPIType(format.photometric.c_str()));
    image.SetPlanarConfiguration(format.planar ? 1 : 0);
    auto sequence = gdcm::SequenceOfFragments::New();
    gdcm::Fragment fragment;
    fragment.SetByteValue(coded.data(), static_cast<std::uint32_t>(coded.size()));
    sequence->AddFragment(fragment);
    gdcm::DataElement pixels(gdcm::Tag(0x7fe0, 0x0010));
    pixels.SetVR(gdcm::VR::OB);
    pixels.SetValue(*sequence);
    image.SetDataElement(pixels);
    out.resize(image.GetBufferLength());
    if (!image.GetBuffer(out.data())) return "GDCM cannot decode them";
    const gdcm::PixelFormat& decoded = image.GetPixelFormat();
    format.bits_allocated = decoded.GetBitsAllocated();
    format.bits_stored = decoded.GetBitsStored();
    format.high_bit = decoded.GetHighBit();
    format.planar = image.GetPlanarConfiguration() == 1;
    format.photometric = image.GetPhotometricInterpretation().GetString();
    return "";
}

class Library : public CodecLibrary {
  public:
    std::string decode_dicom(const std::string& transfer_syntax, std::string_view coded, DicomPixelFormat& format,
                             std::string& out) const override {
        try {
            return decode_dicom_frame(transfer_syntax, coded, format, out);
        } catch (const std::exception& error) {
            return error.what();
        }
    }
    std::unique_ptr<TiffDecoder> open_tiff(const std::string& path, std::string& reason) const override {
        auto decoder = std::make_unique<Decoder>(path);
        if (decoder->is_open()) return decoder;
        reason = decoder->take_reason("it cannot be opened");
        return nullptr;
    }
    std::string unpack(Codec codec, std::string_view packed, void* target, std::size_t bytes) const override {
        switch (codec) {
            case Codec::Blosc:
                return unpack_blosc(packed, target, bytes);
            case Codec::Zstd:
                return unpack_zstd(packed, target, bytes);
            case Codec::Lz4:
                return unpack_lz4(packed, target, bytes);
        }
        return "an unknown codec";
    }
};

}  // namespace
}  // namespace edgesplat

extern "C" __attribute__((visibility("default"))) const edgesplat::CodecLibrary* edgesplat_codec_library() {
    static const edgesplat::Library library;
    return &library;
}
