// Archives, compressed files, headers of Voreen and Inviwo, names inside files, and files named for what they are.
#include <archive.h>
#include <archive_entry.h>
#include <zlib.h>

#include "tests/unit/volume_test_files.h"

namespace {

namespace fs = std::filesystem;
using edgesplat::load_volume;
using testing::AllOf;
using testing::ContainsRegex;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;
using volume_test::content_of;
using volume_test::refusal;

using Members = std::vector<std::pair<std::string, std::string>>;

class Archives : public volume_test::FolderTest {
  protected:
    /// Writes a zip archive, or a tar archive that `filter` compresses.
    std::string pack(const std::string& name, const Members& members, int filter = ARCHIVE_FILTER_NONE) const {
        archive* out = archive_write_new();
        if (name.ends_with(".zip"))
            archive_write_set_format_zip(out);
        else
            archive_write_set_format_pax_restricted(out);
        archive_write_add_filter(out, filter);
        EXPECT_EQ(archive_write_open_filename(out, file(name).c_str()), ARCHIVE_OK);
        for (const auto& [member, content] : members) {
            archive_entry* entry = archive_entry_new();
            archive_entry_set_pathname(entry, member.c_str());
            archive_entry_set_filetype(entry, AE_IFREG);
            archive_entry_set_perm(entry, 0644);
            archive_entry_set_size(entry, static_cast<la_int64_t>(content.size()));
            EXPECT_EQ(archive_write_header(out, entry), ARCHIVE_OK);
            EXPECT_EQ(archive_write_data(out, content.data(), content.size()), static_cast<la_ssize_t>(content.size()));
            archive_entry_free(entry);
        }
        EXPECT_EQ(archive_write_free(out), ARCHIVE_OK);
        return file(name);
    }
    std::string gzip(const std::string& name, const std::string& content) const {
        const gzFile out = gzopen(file(name).c_str(), "wb");
        EXPECT_EQ(gzwrite(out, content.data(), static_cast<unsigned>(content.size())),
                  static_cast<int>(content.size()));
        gzclose(out);
        return file(name);
    }
};

const std::string kNrrdOfFour = "NRRD0004\ntype: uint8\ndimension: 3\nsizes: 2 2 1\nencoding: raw\n\n\1\2\3\4";
const std::string kVtkOfTwo =
    "# vtk DataFile Version 3.0\nt\nASCII\nDATASET STRUCTURED_POINTS\nDIMENSIONS 2 1 1\nPOINT_DATA 2\n"
    "FIELD f 2\na 1 2 int\n1 2\nb 1 2 int\n3 4\n";

TEST_F(Archives, HeadersFindTheirDataFiles) {
    const Members members{{"set/notes.txt", "hello"},
                          {"set/head/a.mhd",
                           "NDims = 3\nDimSize = 2 2 1\nElementType = MET_UCHAR\n"
                           "ElementDataFile = data/a.raw\n"},
                          {"set/head/data/a.raw", "\1\2\3\4"},
                          {"__MACOSX/set/head/._a.mhd", "junk"},
                          {"set/preview.png", "no picture"}};
    for (const auto& [name, filter] :
         {std::pair{"a.zip", ARCHIVE_FILTER_NONE}, std::pair{"a.tar", ARCHIVE_FILTER_NONE},
          std::pair{"a.tar.gz", ARCHIVE_FILTER_GZIP}, std::pair{"a.tgz", ARCHIVE_FILTER_GZIP},
          std::pair{"a.tar.bz2", ARCHIVE_FILTER_BZIP2}, std::pair{"a.tar.xz", ARCHIVE_FILTER_XZ},
          std::pair{"a.tar.zst", ARCHIVE_FILTER_ZSTD}, std::pair{"odd_name", ARCHIVE_FILTER_GZIP}}) {
        const auto volume = load_volume(pack(name, members, filter));
        EXPECT_THAT(volume.values, ElementsAre(1, 2, 3, 4)) << name;
        EXPECT_EQ(volume.name, file(name));
        EXPECT_EQ(load_volume(file(name) + ":set/head/a.mhd").values, volume.values);
        const auto whole = content_of(file(name));
        write(name, whole.substr(0, whole.size() / 3));
        EXPECT_THAT(refusal(file(name)), HasSubstr(name));
    }
}

TEST_F(Archives, SeveralVolumesAreListed) {
    pack("a.zip", {{"one/a.nrrd", kNrrdOfFour}, {"two.vtk", kVtkOfTwo}});
    EXPECT_THAT(refusal(file("a.zip")), AllOf(HasSubstr("2 volumes"), HasSubstr(file("a.zip") + ":one/a.nrrd"),
                                              HasSubstr(file("a.zip") + ":two.vtk")));
    EXPECT_THAT(load_volume(file("a.zip") + ":one/a.nrrd").values, ElementsAre(1, 2, 3, 4));
    EXPECT_THAT(refusal(file("a.zip") + ":two.vtk:c"),
                AllOf(HasSubstr("a.zip:two.vtk:c"), Not(ContainsRegex("edgesplat-[A-Za-z0-9]{6}/"))));
    const auto inside = load_volume(file("a.zip") + ":two.vtk:b");
    EXPECT_THAT(inside.values, ElementsAre(3, 4));
    EXPECT_EQ(inside.name, file("a.zip") + ":two.vtk:b");
    EXPECT_THAT(refusal(file("a.zip") + ":three.vtk"), AllOf(HasSubstr("no such file"), HasSubstr("two.vtk")));
    EXPECT_THAT(refusal(pack("b.zip", {{"a.txt", "x"}, {"b.txt", "y"}})), HasSubstr("without a volume"));
}

TEST_F(Archives, NoPathLeadsOutOfTheFolder) {
    for (const char* name : {"../evil.nrrd", "a/../../../evil.nrrd", "..\\evil.nrrd", "/evil.nrrd"})
        for (const char* kind : {"a.zip", "a.tar"})
            EXPECT_EQ(load_volume(pack(kind, {{name, kNrrdOfFour}})).values.size(), 4U) << name;
    for (const fs::path& place : {folder_, folder_.parent_path(), fs::path("/")})
        EXPECT_FALSE(fs::exists(place / "evil.nrrd"));
    EXPECT_THAT(refusal(file("a.tar") + ":../../../etc/passwd"), HasSubstr("no such file in the archive"));
}

TEST_F(Archives, CompressedFilesOfAnyFormat) {
    EXPECT_THAT(load_volume(gzip("a.nrrd.gz", kNrrdOfFour)).values, ElementsAre(1, 2, 3, 4));
    EXPECT_EQ(load_volume(file("a.nrrd.gz")).name, file("a.nrrd.gz"));
    EXPECT_THAT(load_volume(gzip("without_ending", kNrrdOfFour)).values, ElementsAre(1, 2, 3, 4));
    EXPECT_THAT(load_volume(gzip("a.vtk.gz", kVtkOfTwo) + ":b").values, ElementsAre(3, 4));
    EXPECT_THAT(refusal(file("a.vtk.gz") + ":c"),
                AllOf(HasSubstr("a.vtk.gz:c"), Not(ContainsRegex("edgesplat-[A-Za-z0-9]{6}/"))));
    EXPECT_THAT(load_volume(pack("a.zip", {{"a.nrrd.gz", content_of(file("a.nrrd.gz"))}})).values,
                ElementsAre(1, 2, 3, 4));
    gzip("twice.gz", content_of(file("a.nrrd.gz")));
    EXPECT_THAT(load_volume(file("twice.gz")).values, ElementsAre(1, 2, 3, 4));
    pack("b.zip", {{"c.tar.gz", content_of(pack("c.tar.gz", {{"a", kNrrdOfFour}}, ARCHIVE_FILTER_GZIP))}});
    EXPECT_THAT(refusal(file("b.zip")), HasSubstr("an archive in an archive"));
    const auto whole = content_of(file("a.vtk.gz"));
    EXPECT_THAT(refusal(write("b.vtk.gz", whole.substr(0, whole.size() / 2))), HasSubstr("b.vtk.gz"));
    // Its checksum is compared.
    auto damaged = whole;
    damaged[whole.size() - 7] = static_cast<char>(damaged[whole.size() - 7] ^ 1);
    EXPECT_THAT(refusal(write("c.vtk.gz", damaged)), HasSubstr("truncated or damaged gzip data"));
}

TEST_F(Archives, NamesInsideFiles) {
    write("a.nrrd", kNrrdOfFour);
    EXPECT_THAT(refusal(file("a.nrrd") + ":x"), HasSubstr("has no names inside"));
    EXPECT_THAT(refusal(folder_.string() + ":x"), HasSubstr("has no names inside"));
    EXPECT_THAT(refusal(file("none.vtk") + ":x"), HasSubstr("no such file"));
    // A file whose name has a colon is that file.
    write("b.vtk:c", kNrrdOfFour);
    write("b.vtk", kVtkOfTwo);
    EXPECT_EQ(load_volume(file("b.vtk:c")).values.size(), 4U);
    const auto [path, inner] = edgesplat::split_inner(file("b.vtk") + ":d:e");
    EXPECT_EQ(path, file("b.vtk"));
    EXPECT_EQ(inner, "d:e");
}

TEST_F(Archives, VoreenAndInviwo) {
    write("a.raw", std::string("\0\1\0\2\0\3\0\4\0\5\0\6", 12));
    const std::string head = "ObjectFileName: a.raw\nResolution: 3 2 1\nFormat: USHORT\nByteOrder: BigEndian\n";
    const auto voreen = load_volume(write("a.dat", head + "TaggedFileName: ---\nSliceThickness: 0.5 1 2\n"
                                                          "ObjectModel: I\nGridType: EQUIDISTANT\n"));
    EXPECT_THAT(voreen.values, ElementsAre(1, 2, 3, 4, 5, 6));
    EXPECT_EQ(voreen.geometry.spacing(), glm::dvec3(0.5, 1, 2));
    EXPECT_EQ(voreen.geometry.origin, glm::dvec3(-0.5, -0.5, 0));  // centred
    EXPECT_EQ(voreen.geometry_source, "SliceThickness");
    // The lines are the matrix's rows: its first column is the first axis, of 3 voxels.
    const auto inviwo = load_volume(
        write("b.dat",
              "# comment\nRawFile: a.raw\nResolution: 3 2 1\nFormat: UINT16\nByteOrder: BigEndian\n"
              "BasisVector1: 0 4 0\nBasisVector2: 3 0 0\nBasisVector3: 0 0 5\nOffset: 1 1 1\nDataRange: 0 10\n"
              "ValueRange: -1000 1000\nAxis1Unit: cm\nAxis2Unit: cm\nAxis3Unit: cm\n"
              "WorldVector1: 1 0 0 7\nWorldVector2: 0 1 0 0\nWorldVector3: 0 0 1 0\nWorldVector4: 0 0 0 1\n"));
    EXPECT_EQ(inviwo.geometry.index_to_world_axes[0], glm::dvec3(0, 10, 0));
    EXPECT_EQ(inviwo.geometry.index_to_world_axes[1], glm::dvec3(20, 0, 0));
    EXPECT_EQ(inviwo.geometry.origin, glm::dvec3(90, 15, 35));
    EXPECT_THAT(inviwo.values, ElementsAre(-800, -600, -400, -200, 0, 200));
    EXPECT_EQ(inviwo.length_unit, "cm");
    EXPECT_THAT(refusal(write("c.dat", "ObjectFileName: a.raw\nResolution: 3 2 2\nFormat: USHORT\n")),
                HasSubstr("truncated"));
    EXPECT_THAT(refusal(write("d.dat", "ObjectFileName: b.raw\nResolution: 3 2 1\nFormat: USHORT\n")),
                HasSubstr("b.raw"));
    EXPECT_THAT(refusal(write("e.dat", head + "SliceThickness: 1 0 1\n")), HasSubstr("above 0"));
    EXPECT_THAT(refusal(write("f.dat", "ObjectFileName: a.raw\nResolution: 3 2 1\nFormat: FLOAT16\n")),
                HasSubstr("'FLOAT16'"));
    EXPECT_THAT(load_volume(write("wien.dat", std::string("\2\0\1\0\1\0\5\0\6\1", 10))).values, ElementsAre(5, 262));
}

TEST_F(Archives, FilesAreNamedForWhatTheyAre) {
    const std::vector<std::array<std::string, 3>> files{
        {"a.nii", "<!DOCTYPE html>\n<html><body>Log in</body></html>", "web page"},
        {"a.nrrd", "version https://git-lfs.github.com/spec/v1\noid sha256:1\nsize 5\n", "git lfs pull"},
        {"a.mhd", "%PDF-1.4", "PDF"},
        {"a.7z", "7z\xbc\xaf\x27\x1c", "7z"},
        {"a.am", "# AmiraMesh BINARY-LITTLE-ENDIAN 2.1\n", "Amira"},
        {"a.mat", "MATLAB 5.0 MAT-file, Platform: GLNXA64", "MATLAB"},
        {"a.par", "# === DATA DESCRIPTION FILE ===\n", "Philips PAR"},
        {"a.stl", "solid x\nfacet normal 0 0 1\n", "surface (STL)"},
        {"a.ply", "ply\nformat ascii 1.0\n", "surface (PLY)"},
        {"a.csv", "x,y,z\n1,2,3\n", "unknown volume format: a table of text"},
        {"a.txt", "hello\n", "unknown volume format: a text file"},
        {"a.gii", "<?xml version=\"1.0\"?>\n<GIFTI Version=\"1.0\">", "GIFTI"},
        {"a.vdb", std::string(" BDV\0\0\0\0", 8), "OpenVDB"},
        {"a.czi", "ZISRAWFILE", "bfconvert"},
        {"a.json", "{\"a\": 1}", "JSON"}};
    for (const auto& [name, content, expected] : files)
        EXPECT_THAT(refusal(write(name, content)), HasSubstr(expected));
    EXPECT_THAT(refusal(gzip("a.txt.gz", "hello\n")), AllOf(HasSubstr("a.txt.gz"), HasSubstr("a text file")));
}

}  // namespace
