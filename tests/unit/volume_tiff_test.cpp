// TIFF stacks written by libtiff with each of its codecs, and the cases of other programs' users. The comparison with
// tifffile is in tests/python/test_readers_tiff.py.
#include <tiffio.h>

#include "volume_test_files.h"

namespace {

using namespace volume_test;
using edgesplat::load_volume;
using testing::HasSubstr;

struct TiffFormat {
    int compression = COMPRESSION_NONE, bits = 16, format = SAMPLEFORMAT_UINT, predictor = 0;
    bool is_tiled = false;
    const char* mode = "w";
};

constexpr int kTiffWidth = 37, kTiffHeight = 21, kTiffPages = 2;

/// Sample (x, y) of a page.
double tiff_sample(const TiffFormat& format, int x, int y, int page) {
    const int value = x + 3 * y + 50 * page;
    if (format.bits == 1) return (x / 3 + y) % 2;
    return format.format == SAMPLEFORMAT_IEEEFP ? value / 4.0 - 20 : value;
}

void put_tiff_sample(const TiffFormat& format, std::vector<unsigned char>& row, int x, double value) {
    const auto put = [&](auto sample) {
        std::memcpy(row.data() + static_cast<std::size_t>(x) * sizeof sample, &sample, sizeof sample);
    };
    if (format.bits == 1)
        row[static_cast<std::size_t>(x / 8)] |= static_cast<unsigned char>(static_cast<int>(value) << (7 - x % 8));
    else if (format.bits == 8)
        put(static_cast<std::uint8_t>(value));
    else if (format.bits == 16)
        put(static_cast<std::uint16_t>(value));
    else
        put(static_cast<float>(value));
}

void write_tiff(const std::string& path, const TiffFormat& format) {
    TIFF* tiff = TIFFOpen(path.c_str(), format.mode);
    ASSERT_NE(tiff, nullptr);
    for (int page = 0; page < kTiffPages; ++page) {
        TIFFSetField(tiff, TIFFTAG_IMAGEWIDTH, kTiffWidth);
        TIFFSetField(tiff, TIFFTAG_IMAGELENGTH, kTiffHeight);
        TIFFSetField(tiff, TIFFTAG_BITSPERSAMPLE, format.bits);
        TIFFSetField(tiff, TIFFTAG_SAMPLEFORMAT, format.format);
        TIFFSetField(tiff, TIFFTAG_PHOTOMETRIC, PHOTOMETRIC_MINISBLACK);
        ASSERT_EQ(TIFFSetField(tiff, TIFFTAG_COMPRESSION, format.compression), 1);
        if (format.predictor != 0) TIFFSetField(tiff, TIFFTAG_PREDICTOR, format.predictor);
        const int side = 16;
        const int width = format.is_tiled ? side : kTiffWidth;
        const auto row_bytes = static_cast<std::size_t>((width * format.bits + 7) / 8);
        if (format.is_tiled) {
            TIFFSetField(tiff, TIFFTAG_TILEWIDTH, side);
            TIFFSetField(tiff, TIFFTAG_TILELENGTH, side);
            for (int top = 0; top < kTiffHeight; top += side)
                for (int left = 0; left < kTiffWidth; left += side) {
                    std::vector<unsigned char> tile;
                    for (int y = top; y < top + side; ++y) {
                        std::vector<unsigned char> row(row_bytes);
                        for (int x = 0; x < side; ++x)
                            put_tiff_sample(format, row, x, tiff_sample(format, left + x, y, page));
                        tile.insert(tile.end(), row.begin(), row.end());
                    }
                    ASSERT_GT(TIFFWriteTile(tiff, tile.data(), static_cast<std::uint32_t>(left),
                                            static_cast<std::uint32_t>(top), 0, 0),
                              0);
                }
        } else {
            TIFFSetField(tiff, TIFFTAG_ROWSPERSTRIP, 8);
            for (int y = 0; y < kTiffHeight; ++y) {
                std::vector<unsigned char> row(row_bytes);
                for (int x = 0; x < kTiffWidth; ++x)
                    put_tiff_sample(format, row, x, tiff_sample(format, x, y, page));
                ASSERT_EQ(TIFFWriteScanline(tiff, row.data(), static_cast<std::uint32_t>(y), 0), 1);
            }
        }
        ASSERT_EQ(TIFFWriteDirectory(tiff), 1);
    }
    TIFFClose(tiff);
}

using Tiff = FolderTest;

TEST_F(Tiff, ReadsEveryCodec) {
    const TiffFormat formats[] = {
        {.compression = COMPRESSION_LZW},
        {.compression = COMPRESSION_LZW, .predictor = 2, .mode = "wb"},
        {.compression = COMPRESSION_PACKBITS, .bits = 8},
        {.compression = COMPRESSION_ADOBE_DEFLATE, .predictor = 2, .is_tiled = true},
        {.compression = COMPRESSION_ADOBE_DEFLATE, .bits = 32, .format = SAMPLEFORMAT_IEEEFP, .predictor = 3},
        {.compression = COMPRESSION_ZSTD, .bits = 32, .format = SAMPLEFORMAT_IEEEFP, .is_tiled = true, .mode = "wb8"},
        {.compression = COMPRESSION_LZMA},
        {.compression = COMPRESSION_LERC, .bits = 32, .format = SAMPLEFORMAT_IEEEFP},
        {.compression = COMPRESSION_CCITTFAX4, .bits = 1},
        {.compression = COMPRESSION_CCITTRLE, .bits = 1},
        {.compression = COMPRESSION_JPEG, .bits = 8},
        {.bits = 1, .mode = "wl"},
        {.bits = 16, .is_tiled = true, .mode = "wb8"},
    };
    for (const TiffFormat& format : formats) {
        SCOPED_TRACE(format.compression);
        if (TIFFIsCODECConfigured(static_cast<std::uint16_t>(format.compression)) == 0) continue;
        write_tiff(file("a.tif"), format);
        const auto volume = load_volume(file("a.tif"));
        ASSERT_EQ(volume.geometry.dims, glm::ivec3(kTiffWidth, kTiffHeight, kTiffPages));
        const double tolerance = format.compression == COMPRESSION_JPEG ? 12 : 0;
        for (int z = 0; z < kTiffPages; ++z)
            for (int y = 0; y < kTiffHeight; ++y)
                for (int x = 0; x < kTiffWidth; ++x)
                    ASSERT_NEAR(volume.at(x, y, z), tiff_sample(format, x, y, z), tolerance)
                        << x << ' ' << y << ' ' << z;
    }
}

TEST_F(Tiff, ValuesBeyondFloatsAreScaledOrNoData) {
    const auto write_doubles = [&](const std::string& path, const std::vector<double>& values) {
        TIFF* tiff = TIFFOpen(path.c_str(), "w");
        ASSERT_NE(tiff, nullptr);
        for (int page = 0; page < 2; ++page) {
            TIFFSetField(tiff, TIFFTAG_IMAGEWIDTH, static_cast<int>(values.size()));
            TIFFSetField(tiff, TIFFTAG_IMAGELENGTH, 1);
            TIFFSetField(tiff, TIFFTAG_BITSPERSAMPLE, 64);
            TIFFSetField(tiff, TIFFTAG_SAMPLEFORMAT, SAMPLEFORMAT_IEEEFP);
            TIFFSetField(tiff, TIFFTAG_PHOTOMETRIC, PHOTOMETRIC_MINISBLACK);
            std::vector<double> row = values;
            ASSERT_EQ(TIFFWriteScanline(tiff, row.data(), 0, 0), 1);
            ASSERT_EQ(TIFFWriteDirectory(tiff), 1);
        }
        TIFFClose(tiff);
    };
    write_doubles(file("large.tif"), {0, 1e50, 2e50, 3e50});
    const edgesplat::Volume large = load_volume(file("large.tif"));
    EXPECT_EQ(large.non_finite_count, 0U);
    EXPECT_NEAR(large.in_file_unit(static_cast<double>(large.max_value)) / 3e50, 1, 1e-6);
    write_doubles(file("fill.tif"), {0, 1, 2, 1e200});
    const edgesplat::Volume fill = load_volume(file("fill.tif"));
    EXPECT_EQ(fill.non_finite_count, 2U);
    EXPECT_THAT(fill.warnings, testing::Contains(HasSubstr("2 samples are above 1e+100 in magnitude")));
}

TEST_F(Tiff, NamesDamagedPages) {
    write_tiff(file("a.tif"), {.compression = COMPRESSION_ADOBE_DEFLATE});
    std::string bytes = content_of(file("a.tif"));
    for (std::size_t at = 8; at < 40; ++at)
        bytes[at] = '\x55';
    EXPECT_THAT(refusal(write("b.tif", bytes)), HasSubstr("page 0 of"));
}

TEST_F(Tiff, ReadsCasesOfOtherPrograms) {
    if (!fs::exists(data("odd/cases/tiff/a_stack.tif"))) GTEST_SKIP() << "EDGESPLAT_DATA has no odd/cases/tiff";
    const auto first = load_volume(data("odd/cases/tiff/a_stack.tif"));
    const auto expect_same = [&](const edgesplat::Volume& volume) {
        EXPECT_EQ(volume.geometry.dims, glm::ivec3(40, 44, 24));
        EXPECT_LT(glm::length(volume.geometry.spacing() - glm::dvec3(1.6e-3, 1.6e-3, 2.8e-3)), 1e-9);
        EXPECT_EQ(volume.length_unit.ends_with("m"), true) << volume.length_unit;
    };
    expect_same(first);
    const auto other = load_volume(data("odd/cases/tiff/b_one_ifd.tif"));
    expect_same(other);
    EXPECT_EQ(other.values, first.values);
    for (const char* name : {"odd/cases/tiff/c_two_channels.tif", "odd/cases/tiff/d_ome.ome.tif"}) {
        EXPECT_THAT(refusal(data(name)), HasSubstr("2 components; choose one with --component 0..1"));
        expect_same(load_volume(data(name), {.component = 0}));
        EXPECT_NE(load_volume(data(name), {.component = 0}).values, load_volume(data(name), {.component = 1}).values);
    }
}

}  // namespace
