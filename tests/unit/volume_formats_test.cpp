// Small files of every format, written here: voxels and geometry round-trip; damaged files are refused with a reason.
#include <itkGiplImageIO.h>
#include <itkMetaImageIO.h>
#include <itkNiftiImageIO.h>
#include <itkNrrdImageIO.h>
#include <itkVTKImageIO.h>
#include <sys/stat.h>
#include <zlib.h>

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>
#include <vector>

#include "volume_test_files.h"

namespace {

using namespace volume_test;
using edgesplat::load_volume;
using edgesplat::LoadOptions;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

class Formats : public FolderTest {};

TEST_F(Formats, NrrdKeepsVoxelsAndGeometry) {
    for (const bool compress : {false, true})
        for (const char* name : {"a.nrrd", "b.nhdr"}) {
            write_itk(itk::NrrdImageIO::New(), file(name), {}, compress);
            const auto volume = load_volume(file(name));
            expect_voxels(volume);
            expect_place(volume, {});
            EXPECT_EQ(volume.stored_type, "int16");
        }
}

TEST_F(Formats, MetaImageKeepsVoxelsAndGeometry) {
    for (const bool compress : {false, true})
        for (const char* name : {"a.mha", "b.mhd"}) {
            write_itk(itk::MetaImageIO::New(), file(name), {}, compress);
            const auto volume = load_volume(file(name));
            expect_voxels(volume);
            expect_place(volume, {});
        }
}

TEST_F(Formats, ReadsMetaImageWithWrongCompressedSize) {
    write_itk(itk::MetaImageIO::New(), file("a.mha"), {}, true);
    auto bytes = content_of(file("a.mha"));
    const auto at = bytes.find("CompressedDataSize = ") + 21;
    bytes.replace(at, bytes.find('\n', at) - at, "40");
    expect_voxels(load_volume(write("a.mha", bytes)));
    EXPECT_THAT(refusal(write("b.mha", bytes.substr(0, bytes.size() - 9))), HasSubstr("truncated"));
}

TEST_F(Formats, ReadsMetaImageInSeveralFiles) {
    write("s1", "abcd");
    write("s2", "efgh");
    const std::string head = "NDims = 3\nDimSize = 2 2 2\nElementType = MET_UCHAR\nElementDataFile = ";
    for (const char* files : {"LIST\ns1\ns2\n", "s%d 1 2 1\n"})
        EXPECT_EQ(load_volume(write("a.mhd", head + files)).values[4], 101.0F) << files;
    for (const char* files : {"LIST\ns1\n", "LIST\ns1\ns3\n", "s%d 1 3 1\n", "s%d 2 3 1\n", "s%s%n 1 2 1\n", "s%d\n"})
        EXPECT_THAT(refusal(write("a.mhd", head + files)), HasSubstr("a.mhd")) << files;
}

TEST_F(Formats, NiftiKeepsVoxelsAndGeometry) {
    for (const char* name : {"a.nii", "b.nii.gz", "c.hdr"}) {
        write_itk(itk::NiftiImageIO::New(), file(name));
        const auto volume = load_volume(file(name));
        expect_voxels(volume);
        expect_place(volume, {});
        EXPECT_LT(glm::determinant(volume.geometry.index_to_world_axes), 0);
    }
}

/// Converts a NIfTI-1 file to NIfTI-2, little or big endian.
std::string as_nifti2(const std::string& one, bool big) {
    std::string two(544, '\0');
    const auto put = [&]<typename T>(std::size_t at, T value) {
        std::memcpy(&two[at], &value, sizeof value);
        if (big) std::reverse(two.begin() + static_cast<long>(at), two.begin() + static_cast<long>(at + sizeof value));
    };
    const auto get = [&]<typename T>(std::size_t at, T value) {
        std::memcpy(&value, &one[at], sizeof value);
        return value;
    };
    put(0, std::int32_t{540});
    two.replace(4, 8, "n+2\0\r\n\032\n", 8);
    put(12, get(70, std::int16_t{}));
    put(14, get(72, std::int16_t{}));
    for (std::size_t i = 0; i < 8; ++i) {
        put(16 + 8 * i, std::int64_t{get(40 + 2 * i, std::int16_t{})});
        put(104 + 8 * i, double{get(76 + 4 * i, float{})});
    }
    put(168, std::int64_t{544});
    for (std::size_t i = 0; i < 2; ++i) {
        put(176 + 8 * i, double{get(112 + 4 * i, float{})});
        put(344 + 4 * i, std::int32_t{get(252 + 2 * i, std::int16_t{})});
    }
    for (std::size_t i = 0; i < 18; ++i)
        put(352 + 8 * i, double{get(256 + 4 * i, float{})});
    put(500, std::int32_t{one[123]});
    std::string voxels = one.substr(352);
    for (std::size_t i = 0; big && i + 1 < voxels.size(); i += 2)
        std::swap(voxels[i], voxels[i + 1]);
    return two + voxels;
}

TEST_F(Formats, Nifti2KeepsVoxelsAndGeometry) {
    write_itk(itk::NiftiImageIO::New(), file("one.nii"));
    for (const bool big : {false, true}) {
        const std::string bytes = as_nifti2(content_of(file("one.nii")), big);
        const gzFile packed = gzopen(file("b.nii.gz").c_str(), "wb");
        EXPECT_GT(gzwrite(packed, bytes.data(), static_cast<unsigned>(bytes.size())), 0);
        gzclose(packed);
        for (const std::string& path : {write("a.nii", bytes), file("b.nii.gz")}) {
            const auto volume = load_volume(path);
            expect_voxels(volume);
            expect_place(volume, {});
            EXPECT_EQ(volume.stored_type, "int16");
        }
        EXPECT_THAT(refusal(write("c.nii", bytes.substr(0, bytes.size() - 20))), HasSubstr("truncated"));
    }
    std::string wide = as_nifti2(content_of(file("one.nii")), false);
    const std::int64_t voxels = 40000;
    std::memcpy(&wide[24], &voxels, sizeof voxels);
    EXPECT_EQ(load_volume(write("d.nii", wide + std::string(1 << 20, ' '))).geometry.dims, glm::ivec3(40000, 4, 3));
}

TEST_F(Formats, VtkAndGiplKeepVoxels) {
    const Place straight{.directions = glm::dmat3(1)};
    write_itk(itk::VTKImageIO::New(), file("a.vtk"), straight);
    const auto volume = load_volume(file("a.vtk"));
    expect_voxels(volume);
    expect_place(volume, straight);
    write_itk(itk::GiplImageIO::New(), file("b.gipl"), straight);
    expect_voxels(load_volume(file("b.gipl")));
}

TEST_F(Formats, ReadsNrrdBzip2) {
    // bzip2 of the 8 bytes 1 2 3 4 5 6 7 8
    const unsigned char packed[] = {0x42, 0x5a, 0x68, 0x39, 0x31, 0x41, 0x59, 0x26, 0x53, 0x59, 0xeb,
                                    0xf4, 0x72, 0x27, 0x00, 0x00, 0x00, 0x40, 0x00, 0x3f, 0xc0, 0x20,
                                    0x00, 0x31, 0x0c, 0x08, 0x19, 0x1a, 0x69, 0x93, 0x35, 0x73, 0xf9,
                                    0x45, 0xdc, 0x91, 0x4e, 0x14, 0x24, 0x3a, 0xfd, 0x1c, 0x89, 0xc0};
    const std::string bytes(reinterpret_cast<const char*>(packed), sizeof(packed));
    const std::string head = "NRRD0004\ntype: uint8\ndimension: 3\nsizes: 2 2 2\nencoding: bzip2\n";
    write("a.nrrd", head + "\n" + bytes);
    const auto volume = load_volume(file("a.nrrd"));
    EXPECT_THAT(volume.values, testing::ElementsAre(1, 2, 3, 4, 5, 6, 7, 8));
    write("b.bz2", "skip me\n" + bytes);
    write("b.nhdr", head + "line skip: 1\ndata file: b.bz2\n");
    EXPECT_EQ(load_volume(file("b.nhdr")).values, volume.values);
    write("c.nrrd", head + "\n" + bytes.substr(0, 20));
    EXPECT_THAT(refusal(file("c.nrrd")), AllOf(HasSubstr("c.nrrd"), HasSubstr("truncated")));
}

TEST_F(Formats, ReadsNrrdInSeveralFiles) {
    for (int i = 1; i <= 3; ++i)
        write("part." + std::to_string(i), std::string(4, static_cast<char>(i)));
    const std::string head = "NRRD0004\ntype: uint8\ndimension: 3\nsizes: 2 2 3\nencoding: raw\n";
    write("a.nhdr", head + "data file: part.%d 1 3 1 2\n");
    EXPECT_THAT(load_volume(file("a.nhdr")).values, testing::ElementsAre(1, 1, 1, 1, 2, 2, 2, 2, 3, 3, 3, 3));
    write("b.nhdr", head + "data file: LIST\npart.3\npart.2\npart.1\n");
    EXPECT_EQ(load_volume(file("b.nhdr")).values.front(), 3.0F);
    fs::remove(file("part.2"));
    EXPECT_THAT(refusal(file("a.nhdr")), AllOf(HasSubstr("a.nhdr"), HasSubstr("part.2")));
    write("c.nhdr", head + "data file: part.%s%n 1 3 1 2\n");
    EXPECT_THAT(refusal(file("c.nhdr")), HasSubstr("must hold one number"));
}

TEST_F(Formats, RequiresChoiceOfNrrdFrameAndComponent) {
    const std::string values = {1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16};
    const std::string space = "space: left-posterior-superior\nspace directions: (1,0,0) (0,1,0) (0,0,1) none\n";
    write("t.nrrd", "NRRD0005\ntype: uint8\ndimension: 4\n" + space + "sizes: 2 2 2 2\nencoding: raw\n\n" + values);
    EXPECT_THAT(refusal(file("t.nrrd")), HasSubstr("--frame 0..1"));
    EXPECT_EQ(load_volume(file("t.nrrd"), {.frame = 1}).values.front(), 9.0F);
    EXPECT_THAT(refusal(file("t.nrrd"), {.frame = 2}), HasSubstr("--frame 2"));
    write("v.nrrd",
          "NRRD0004\ntype: uint8\ndimension: 4\nkinds: vector domain domain domain\nsizes: 2 2 2 2\n"
          "encoding: raw\n\n" +
              values);
    EXPECT_THAT(refusal(file("v.nrrd")), HasSubstr("--component 0..1"));
    EXPECT_THAT(load_volume(file("v.nrrd"), {.component = 1}).values, testing::ElementsAre(2, 4, 6, 8, 10, 12, 14, 16));
}

TEST_F(Formats, RefusesOversizedHeadersBeforeAllocating) {
    const auto nrrd = [&](const std::string& sizes) {
        write("a.nrrd",
              "NRRD0004\ntype: float\ndimension: 3\nsizes: " + sizes + "\nendian: little\nencoding: raw\n\nabcd");
        return refusal(file("a.nrrd"));
    };
    EXPECT_THAT(nrrd("4000000000 4000000000 4000000000"), HasSubstr("a.nrrd"));
    EXPECT_THAT(nrrd("3037000500 3037000500 2"), HasSubstr("a.nrrd"));
    EXPECT_THAT(nrrd("60000 60000 60000"), HasSubstr("at most"));
    EXPECT_THAT(nrrd("1000 1000 1000"), HasSubstr("only"));
    EXPECT_THAT(nrrd("0 2 2"), HasSubstr("at least 1"));
    EXPECT_THAT(nrrd("-2 2 2"), HasSubstr("at least 1"));
    EXPECT_THAT(nrrd("2 2 2"), HasSubstr("a.nrrd"));
    write("a.mhd", "NDims = 3\nDimSize = 60000 60000 60000\nElementType = MET_FLOAT\nElementDataFile = a.nrrd\n");
    EXPECT_THAT(refusal(file("a.mhd")), HasSubstr("at most"));
    write("b.mhd", "NDims = 3\nDimSize = 2 2 2\nElementType = MET_FLOAT\nElementDataFile = missing.raw\n");
    EXPECT_THAT(refusal(file("b.mhd")), HasSubstr("missing.raw"));
}

TEST_F(Formats, RefusesTruncatedFiles) {
    write_itk(itk::NrrdImageIO::New(), file("a.nrrd"));
    write_itk(itk::MetaImageIO::New(), file("a.mha"));
    write_itk(itk::NiftiImageIO::New(), file("a.nii"));
    write_itk(itk::NiftiImageIO::New(), file("a.nii.gz"));
    write_itk(itk::VTKImageIO::New(), file("a.vtk"), {.directions = glm::dmat3(1)});
    for (const char* name : {"a.nrrd", "a.mha", "a.nii", "a.nii.gz", "a.vtk"}) {
        const auto whole = content_of(file(name));
        for (const std::size_t lost : {std::size_t{20}, whole.size() / 8, whole.size() / 2}) {
            write(name, whole.substr(0, whole.size() - lost));
            EXPECT_THAT(refusal(file(name)), HasSubstr(name)) << lost;
        }
    }
}

// ITK's NIfTI library turns NaN into 0; NaN must be counted instead.
TEST_F(Formats, CountsNonFiniteNiftiSamples) {
    write_itk(itk::NiftiImageIO::New(), file("a.nii"));
    auto bytes = content_of(file("a.nii"));
    const std::int16_t datatype = 16, bitpix = 32;
    std::memcpy(&bytes[70], &datatype, 2);
    std::memcpy(&bytes[72], &bitpix, 2);
    const float slope = 2, intercept = 1;
    std::memcpy(&bytes[112], &slope, 4);
    std::memcpy(&bytes[116], &intercept, 4);
    std::vector<float> values(60, 3.0F);
    values[7] = NAN;
    values[8] = INFINITY;
    values[9] = -4.0F;
    bytes.resize(352);
    bytes.append(reinterpret_cast<const char*>(values.data()), values.size() * 4);
    const auto volume = load_volume(write("a.nii", bytes));
    EXPECT_EQ(volume.non_finite_count, 2U);
    EXPECT_EQ(volume.min_value, -7.0F);
    EXPECT_EQ(volume.max_value, 7.0F);
    EXPECT_EQ(volume.values[7], -7.0F);
}

TEST_F(Formats, ReadsRaw) {
    const std::string bytes = {0, 1, 0, 2, 0, 3, 0, 4, 0, 5, 0, 6, 0, 7, 1, 0};
    write("a.raw", bytes);
    EXPECT_THAT(refusal(file("a.raw")), HasSubstr("--raw"));
    const auto big = load_volume(file("a.raw"), {.raw = "2x2x2:uint16:big:1,2,3"});
    EXPECT_THAT(big.values, testing::ElementsAre(1, 2, 3, 4, 5, 6, 7, 256));
    EXPECT_EQ(big.geometry.spacing(), glm::dvec3(1, 2, 3));
    EXPECT_EQ(load_volume(file("a.raw"), {.raw = "2x2x2:uint16:little"}).values[7], 1.0F);
    EXPECT_EQ(load_volume(file("a.raw"), {.raw = "2x2x3:uint8:little:1,1,1:4"}).values[1], 3.0F);
    for (const char* wrong :
         {"2x2x2", "2x2:uint8:little", "2x2x2:uint7:little", "2x2x2:uint16:middle", "2x2x2:uint16:big:1,2",
          "2x2x2:uint16:big:1,2,-3", "2x2x2:uint16:big:1,1,1:x", "ax2x2:uint8:little", "4x4x4:uint16:little",
          "2x2x1:uint16:little", "0x2x2:uint8:little", "2x2x2:uint16:big:1,1,1:99999999999999999999"})
        EXPECT_NE(refusal(file("a.raw"), {.raw = wrong}), "") << wrong;
}

TEST_F(Formats, SpacingOptionOverridesFile) {
    write_itk(itk::NrrdImageIO::New(), file("a.nrrd"));
    const auto volume = load_volume(file("a.nrrd"), {.spacing = glm::dvec3(1, 2, 4)});
    expect_place(volume, {.spacing = {1, 2, 4}});
    EXPECT_THAT(refusal(file("a.nrrd"), {.spacing = glm::dvec3(1, 0, 4)}), HasSubstr("--spacing"));
}

TEST_F(Formats, ProgressRisesToTheEnd) {
    write_itk(itk::NrrdImageIO::New(), file("a.nrrd"));
    std::vector<double> fractions;
    (void)load_volume(file("a.nrrd"), {.progress = [&](double f, std::string_view) { fractions.push_back(f); }});
    ASSERT_GE(fractions.size(), 3U);
    EXPECT_TRUE(std::is_sorted(fractions.begin(), fractions.end()));
    EXPECT_EQ(fractions.back(), 1.0);
}

// A 2-D image is a volume of one slice, with a note; a 1-D file is refused.
TEST_F(Formats, ReadsTwoDimensionsAsOneSlice) {
    write("a.nrrd", "NRRD0004\ntype: uint8\ndimension: 2\nsizes: 2 2\nencoding: raw\n\nabcd");
    const auto volume = load_volume(file("a.nrrd"));
    EXPECT_EQ(volume.geometry.dims, glm::ivec3(2, 2, 1));
    ASSERT_FALSE(volume.notes.empty());
    EXPECT_THAT(volume.notes[0], HasSubstr("one slice"));
    write("b.nrrd", "NRRD0004\ntype: uint8\ndimension: 1\nsizes: 4\nencoding: raw\n\nabcd");
    EXPECT_THAT(refusal(file("b.nrrd")), HasSubstr("1 axis"));
}

TEST_F(Formats, RefusesUnreadableFiles) {
    EXPECT_THAT(refusal(file("none.nrrd")), AllOf(HasSubstr("none.nrrd"), HasSubstr("no such")));
    EXPECT_THAT(refusal(write("empty.nrrd", "")), HasSubstr("empty"));
    EXPECT_THAT(refusal(write("text.txt", "hello\n")), HasSubstr("unknown volume format"));
    EXPECT_THAT(refusal(write("junk.nii", std::string(1000, 'x'))), HasSubstr("not a NIfTI"));
    EXPECT_THAT(refusal(write("short.nii", "abc")), HasSubstr("too few"));
    EXPECT_THAT(refusal(write("junk.mha", std::string(1000, 'x'))), HasSubstr("junk.mha"));
    EXPECT_THAT(refusal(write("poly.vtk", "# vtk DataFile Version 3.0\nx\nASCII\nDATASET POLYDATA\n")),
                HasSubstr("not image data"));
    EXPECT_THAT(refusal(""), HasSubstr("no volume"));
    EXPECT_THAT(refusal(folder_.string()), AllOf(HasSubstr("no DICOM files"), HasSubstr(folder_.string())));
    ASSERT_EQ(mkfifo(file("pipe").c_str(), 0600), 0);
    EXPECT_THAT(refusal(file("pipe")), HasSubstr("neither a file nor a folder"));
    if (geteuid() != 0) {
        write("secret.nrrd", "NRRD0004\n");
        ASSERT_EQ(chmod(file("secret.nrrd").c_str(), 0), 0);
        EXPECT_THAT(refusal(file("secret.nrrd")), HasSubstr("cannot be read"));
    }
}

// Messages of libraries must not reach the user's terminal.
TEST_F(Formats, NothingLeaksToStderr) {
    write_itk(itk::NiftiImageIO::New(), file("a.nii"));
    write("a.nii", content_of(file("a.nii")).substr(0, 400));
    write_itk(itk::MetaImageIO::New(), file("a.mha"));
    write("a.mha", content_of(file("a.mha")).substr(0, 350));
    testing::internal::CaptureStderr();
    testing::internal::CaptureStdout();
    (void)refusal(file("a.nii"));
    (void)refusal(file("a.mha"));
    EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
    EXPECT_EQ(testing::internal::GetCapturedStdout(), "");
}

}  // namespace
