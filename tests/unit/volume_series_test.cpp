// DICOM series and sequences of images, written here.
#include <OpenImageIO/imageio.h>
#include <archive.h>
#include <archive_entry.h>

#include <cmath>
#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

#include "dicom_test_files.h"
#include "volume_test_files.h"

namespace {

using namespace volume_test;
using edgesplat::load_volume;
using edgesplat::LoadOptions;
using testing::AllOf;
using testing::HasSubstr;

class Series : public FolderTest {
  protected:
    // Writes a CT slice of width x 3 pixels at `position`, axes along x and y. Pixel (x, y): first + x + 10 y after
    // rescaling.
    void write_slice(const std::string& name, const glm::dvec3& position, int first, const std::string& series = "1",
                     int width = 4) const {
        std::vector<int> pixels;
        for (int y = 0; y < 3; ++y)
            for (int x = 0; x < width; ++x)
                pixels.push_back(first + x + 10 * y + 1000);
        DicomData data = dicom_picture(width, 3, pixels);
        data.text(0x0020000e, "UI", "1.2.3.4." + series).text(0x0008103e, "LO", "series " + series);
        data.text(0x00200032, "DS", dicom_position(position.x, position.y, position.z));
        data.text(0x00200037, "DS", "1\\0\\0\\0\\1\\0").text(0x00280030, "DS", "0.75\\0.5");
        data.text(0x00281052, "DS", "-1000").text(0x00281053, "DS", "1");
        write(name, data.file());
    }
    void write_image(const std::string& name, const std::vector<std::vector<std::uint16_t>>& pages,
                     int channels = 1) const {
        const auto output = OIIO::ImageOutput::create(file(name));
        ASSERT_NE(output, nullptr) << OIIO::geterror();
        const int width = 2;
        const OIIO::ImageSpec spec(width, static_cast<int>(pages[0].size()) / width / channels, channels,
                                   OIIO::TypeDesc::UINT16);
        for (std::size_t page = 0; page < pages.size(); ++page) {
            ASSERT_TRUE(output->open(file(name), spec,
                                     page == 0 ? OIIO::ImageOutput::Create : OIIO::ImageOutput::AppendSubimage))
                << output->geterror();
            ASSERT_TRUE(output->write_image(OIIO::TypeDesc::UINT16, pages[page].data())) << output->geterror();
        }
        ASSERT_TRUE(output->close());
    }
};

TEST_F(Series, SortsDicomByPosition) {
    write_slice("b.dcm", {1, 2, 10}, 0);
    write_slice("a.dcm", {1, 2, 14}, 200);
    write_slice("z.dcm", {1, 2, 12}, 100);
    const auto volume = load_volume(folder_.string());
    ASSERT_EQ(volume.geometry.dims, glm::ivec3(4, 3, 3));
    for (int z = 0; z < 3; ++z)
        EXPECT_EQ(volume.at(3, 2, z), static_cast<float>(100 * z + 23)) << z;
    expect_place(volume, {.directions = glm::dmat3(1), .spacing = {0.5, 0.75, 2}, .origin = {1, 2, 10}});
    EXPECT_THAT(volume.stored_type, HasSubstr("int16"));
}

TEST_F(Series, KeepsDicomGantryTiltInMatrix) {
    for (int z = 0; z < 4; ++z)
        write_slice(std::to_string(9 - z) + ".dcm", {0, 0.5 * z, 2.0 * z}, z);
    const auto volume = load_volume(folder_.string());
    EXPECT_LT(glm::length(volume.geometry.index_to_world_axes[2] - glm::dvec3(0, 0.5, 2)), 1e-6);
    ASSERT_FALSE(volume.notes.empty());
    EXPECT_THAT(volume.notes[0], AllOf(HasSubstr("14.04 degrees"), HasSubstr("tilt")));
}

TEST_F(Series, RefusesUnevenDicomSpacing) {
    for (const double z : {0.0, 2.0, 4.0, 6.1, 8.1})
        write_slice(std::to_string(z) + ".dcm", {0, 0, z}, 0);
    EXPECT_THAT(refusal(folder_.string()), AllOf(HasSubstr("uneven"), HasSubstr("4.000)"), HasSubstr("6.100)"),
                                                 HasSubstr("are 2.1 mm apart, the others 2 mm; --resample")));
    write_slice("9.dcm", {0, 0, 10}, 0);
    EXPECT_THAT(refusal(folder_.string()), HasSubstr("are 2.1 mm apart, the others 1.9 to 2 mm"));
}

TEST_F(Series, ResamplesUnevenDicomSpacingOnRequest) {
    // Values are a parabola along the slices, which shift sideways by 1 mm per 10 mm.
    const auto value = [](double z) { return std::lround(4 * z * z); };
    for (const double z : {0.0, 1.0, 2.0, 3.5, 4.5, 6.0})
        write_slice(std::to_string(z) + ".dcm", {0.1 * z, 0, 5 + z}, static_cast<int>(value(z)));
    const auto volume = load_volume(folder_.string(), {.resample = true});
    ASSERT_EQ(volume.geometry.dims, glm::ivec3(4, 3, 7));
    EXPECT_LT(glm::length(volume.geometry.index_to_world_axes[2] - glm::dvec3(0.1, 0, 1)), 1e-9);
    for (int z = 0; z < 7; ++z)
        EXPECT_NEAR(volume.at(2, 1, z), static_cast<double>(value(z)) + 12, 1e-3) << z;
    EXPECT_THAT(volume.warnings,
                testing::ElementsAre(HasSubstr("6 unevenly spaced slices were resampled to 7, 1 mm apart")));
    write_slice("aside.dcm", {3, 0, 12}, 0);
    EXPECT_THAT(refusal(folder_.string(), {.resample = true}), HasSubstr("one line"));
}

TEST_F(Series, SkipsAndNamesBrokenDicomFiles) {
    for (int z = 0; z < 4; ++z)
        write_slice(std::to_string(z) + ".dcm", {0, 0, 2.0 * z}, 100 * z);
    const auto whole = content_of(file("3.dcm"));
    write("3.dcm", whole.substr(0, whole.size() - 10));
    const auto volume = load_volume(folder_.string());
    EXPECT_EQ(volume.geometry.dims, glm::ivec3(4, 3, 3));
    EXPECT_THAT(volume.warnings,
                testing::ElementsAre(AllOf(HasSubstr("3.dcm"), HasSubstr("truncated"), HasSubstr("skipped"))));
    // A broken slice in the middle leaves a gap, which is reported with its reason, or interpolated.
    write("3.dcm", whole);
    write("2.dcm", content_of(file("2.dcm")).substr(0, whole.size() - 10));
    EXPECT_THAT(refusal(folder_.string()),
                AllOf(HasSubstr("a slice may be missing"), HasSubstr("skipped:"), HasSubstr("2.dcm: truncated")));
    EXPECT_EQ(load_volume(folder_.string(), {.resample = true}).warnings.size(), 2U);
    for (int z = 0; z < 4; ++z)
        write(std::to_string(z) + ".dcm", whole.substr(0, whole.size() - 10));
    EXPECT_THAT(refusal(folder_.string()), HasSubstr("none of its 4 DICOM files"));
}

TEST_F(Series, ReadsDicomWithoutPreamble) {
    for (const bool meta : {true, false}) {
        SCOPED_TRACE(meta);
        for (int z = 0; z < 3; ++z) {
            write_slice("whole", {0, 0, 2.0 * z}, 100 * z);
            const std::string whole = content_of(file("whole"));
            std::uint32_t bytes_of_meta = 0;
            std::memcpy(&bytes_of_meta, &whole[140], 4);
            write(std::to_string(z), whole.substr(meta ? 132 : 144 + bytes_of_meta));
        }
        fs::remove(file("whole"));
        const auto volume = load_volume(folder_.string());
        ASSERT_EQ(volume.geometry.dims, glm::ivec3(4, 3, 3));
        EXPECT_EQ(volume.at(3, 2, 1), 123.0F);
        const auto part = content_of(file("0"));
        for (std::size_t lost = 1; lost < part.size() - 20; lost += 1 + lost / 6)
            EXPECT_THAT(refusal(write("cut.dcm", part.substr(0, part.size() - lost))), HasSubstr("cut.dcm")) << lost;
        fs::remove(file("cut.dcm"));
    }
}

TEST_F(Series, ReadsDicomByPattern) {
    for (int z = 0; z < 3; ++z)
        write_slice("s" + std::to_string(z) + ".dcm", {0, 0, 6.0 - 2.0 * z}, 100 * z);
    for (const char* pattern : {"s%d.dcm", "s*.dcm", "s?.dcm"}) {
        const auto volume = load_volume(file(pattern));
        ASSERT_EQ(volume.geometry.dims, glm::ivec3(4, 3, 3)) << pattern;
        EXPECT_EQ(volume.at(3, 2, 2), 23.0F) << "sorted by position, not by number";
        EXPECT_EQ(volume.geometry.spacing().z, 2);
    }
    write_image("s3.png", {{1, 1, 1, 1}});
    EXPECT_THAT(refusal(file("s*")), AllOf(HasSubstr("3 of the 4 files that match are DICOM"), HasSubstr("s3.png")));
    EXPECT_THAT(refusal(file("t*")), HasSubstr("no file matches"));
    EXPECT_EQ(load_volume(file("*.png")).geometry.dims, glm::ivec3(2, 2, 1));
}

/// Writes a zip archive with these names and contents.
void write_zip(const std::string& path, const std::vector<std::pair<std::string, std::string>>& entries) {
    archive* out = archive_write_new();
    archive_write_set_format_zip(out);
    ASSERT_EQ(archive_write_open_filename(out, path.c_str()), ARCHIVE_OK);
    for (const auto& [name, content] : entries) {
        archive_entry* entry = archive_entry_new();
        archive_entry_set_pathname(entry, name.c_str());
        archive_entry_set_filetype(entry, AE_IFREG);
        archive_entry_set_perm(entry, 0644);
        archive_entry_set_size(entry, static_cast<la_int64_t>(content.size()));
        EXPECT_EQ(archive_write_header(out, entry), ARCHIVE_OK);
        EXPECT_EQ(archive_write_data(out, content.data(), content.size()), static_cast<la_ssize_t>(content.size()));
        archive_entry_free(entry);
    }
    EXPECT_EQ(archive_write_free(out), ARCHIVE_OK);
}

TEST_F(Series, ReadsZipArchives) {
    std::vector<std::pair<std::string, std::string>> entries;
    for (int z = 0; z < 3; ++z) {
        write_slice("slice", {0, 0, 2.0 * z}, 100 * z);
        entries.emplace_back("study/" + std::to_string(z) + "/IM", content_of(file("slice")));
    }
    entries.emplace_back("../../../README.txt", "nothing of it leaves the folder");
    write_zip(file("a.zip"), entries);
    const auto volume = load_volume(file("a.zip"));
    ASSERT_EQ(volume.geometry.dims, glm::ivec3(4, 3, 3));
    EXPECT_EQ(volume.at(3, 2, 1), 123.0F);
    EXPECT_EQ(volume.name, file("a.zip"));
    write_image("b.tif", {{1, 2, 3, 4}, {5, 6, 7, 8}});
    write_zip(file("b.zip"), {{"b.tif", content_of(file("b.tif"))}});
    EXPECT_EQ(load_volume(file("b.zip")).geometry.dims, glm::ivec3(2, 2, 2));

    write_image("s.png", {{1, 2, 3, 4}});
    const std::string slice = content_of(file("s.png"));
    write_zip(file("s.zip"), {{"x/s10.png", slice}, {"x/s9.png", slice}});
    EXPECT_EQ(load_volume(file("s.zip")).geometry.dims, glm::ivec3(2, 2, 2));

    const auto whole = content_of(file("a.zip"));
    for (std::size_t lost = 1; lost < whole.size() - 4; lost += 1 + lost / 3) {
        // Without its directory at the end an archive may be read from its beginning; truncated entries are refused.
        try {
            EXPECT_EQ(load_volume(write("c.zip", whole.substr(0, whole.size() - lost))).values, volume.values) << lost;
        } catch (const edgesplat::Error& error) {
            EXPECT_THAT(error.what(),
                        AllOf(HasSubstr("c.zip"), testing::Not(testing::ContainsRegex("edgesplat-[A-Za-z0-9]{6}/"))))
                << lost;
        }
    }
    write_zip(file("d.zip"), {{"b.zip", content_of(file("b.zip"))}});
    EXPECT_THAT(refusal(file("d.zip")), HasSubstr("an archive in an archive"));
    write_zip(file("e.zip"), {});
    EXPECT_THAT(refusal(file("e.zip")), HasSubstr("e.zip"));
    entries[1].second.resize(entries[1].second.size() - 10);
    write_zip(file("f.zip"), entries);
    EXPECT_THAT(load_volume(file("f.zip")).warnings,
                testing::ElementsAre(AllOf(HasSubstr("f.zip:"), HasSubstr("skipped"))));
}

TEST_F(Series, ReadsOneBitMasksAsZeroAndOne) {
    // A portable bitmap of 8 x 2 pixels.
    const auto volume = load_volume(write("a.pbm", std::string("P4\n8 2\n") + '\x81' + '\x0f'));
    EXPECT_EQ(volume.geometry.dims, glm::ivec3(8, 2, 1));
    EXPECT_EQ(volume.min_value, 0.0F);
    EXPECT_EQ(volume.max_value, 1.0F);
    const auto output = OIIO::ImageOutput::create(file("b.tif"));
    OIIO::ImageSpec spec(8, 1, 1, OIIO::TypeDesc::UINT8);
    spec.attribute("oiio:BitsPerSample", 1);
    ASSERT_TRUE(output->open(file("b.tif"), spec));
    const std::vector<std::uint8_t> pixels{255, 0, 0, 255, 255, 0, 0, 255};
    ASSERT_TRUE(output->write_image(OIIO::TypeDesc::UINT8, pixels.data()) && output->close());
    EXPECT_THAT(load_volume(file("b.tif")).values, testing::ElementsAre(1, 0, 0, 1, 1, 0, 0, 1));
}

TEST_F(Series, RefusesMissingDicomSlice) {
    for (const double z : {0.0, 2.0, 6.0, 8.0})
        write_slice(std::to_string(z) + ".dcm", {0, 0, z}, 0);
    EXPECT_THAT(refusal(folder_.string()), AllOf(HasSubstr("missing"), HasSubstr("2.000)"), HasSubstr("6.000)")));
}

TEST_F(Series, RefusesDicomSlicesAtSamePosition) {
    for (int i = 0; i < 4; ++i)
        write_slice(std::to_string(i) + ".dcm", {0, 0, 2.0 * (i / 2)}, i);
    EXPECT_THAT(refusal(folder_.string()), HasSubstr("same position"));
}

TEST_F(Series, RefusesDicomSlicesOffLine) {
    for (int i = 0; i < 4; ++i)
        write_slice(std::to_string(i) + ".dcm", {i == 2 ? 1.0 : 0.0, 0, 2.0 * i}, 0);
    EXPECT_THAT(refusal(folder_.string()), HasSubstr("one line"));
}

TEST_F(Series, RequiresChoiceOfDicomSeries) {
    for (int z = 0; z < 3; ++z) {
        write_slice("a" + std::to_string(z), {0, 0, 2.0 * z}, 0, "1");
        write_slice("b" + std::to_string(z), {0, 0, 2.0 * z}, 50, "2");
    }
    EXPECT_THAT(refusal(folder_.string()), AllOf(HasSubstr("--series"), HasSubstr("1.2.3.4.2"), HasSubstr("3 files")));
    EXPECT_EQ(load_volume(folder_.string(), {.series = "1"}).at(0, 0, 0), 50.0F);
    EXPECT_EQ(load_volume(folder_.string(), {.series = "1.2.3.4.1"}).at(0, 0, 0), 0.0F);
    EXPECT_THAT(refusal(folder_.string(), {.series = "7"}), HasSubstr("none of its 2 series"));
}

TEST_F(Series, RefusesDicomOfTwoSizes) {
    write_slice("a", {0, 0, 0}, 0);
    write_slice("b", {0, 0, 2}, 0, "1", 6);
    EXPECT_THAT(refusal(folder_.string()), HasSubstr("pixels"));
}

// GDCM aborts the program on some of these; all must be errors.
TEST_F(Series, RefusesTruncatedDicom) {
    write_slice("a.dcm", {0, 0, 0}, 0);
    const auto whole = content_of(file("a.dcm"));
    for (std::size_t lost = 1; lost < whole.size() - 140; lost += 1 + lost / 6) {
        write("a.dcm", whole.substr(0, whole.size() - lost));
        EXPECT_THAT(refusal(file("a.dcm")), HasSubstr("a.dcm")) << lost;
    }
}

TEST_F(Series, TiffStackKeepsStoredValues) {
    write_image("a.tif", {{1, 2, 3, 4}, {5, 6, 7, 65535}});
    const auto volume = load_volume(file("a.tif"), {.spacing = glm::dvec3(0.1, 0.1, 0.3)});
    EXPECT_EQ(volume.geometry.dims, glm::ivec3(2, 2, 2));
    EXPECT_THAT(volume.values, testing::ElementsAre(1, 2, 3, 4, 5, 6, 7, 65535));
    EXPECT_EQ(volume.stored_type, "uint16");
    EXPECT_NEAR(volume.geometry.spacing().z, 0.3, 1e-12);
    const auto whole = content_of(file("a.tif"));
    write("b.tif", whole.substr(0, whole.size() / 2));
    EXPECT_THAT(refusal(file("b.tif")), HasSubstr("b.tif"));
}

TEST_F(Series, ColourImagesNeedAComponent) {
    write_image("a.tif", {{1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12}}, 3);
    EXPECT_THAT(refusal(file("a.tif")), HasSubstr("--component 0..2"));
    EXPECT_THAT(load_volume(file("a.tif"), {.component = 2}).values, testing::ElementsAre(3, 6, 9, 12));
}

TEST_F(Series, SortsImagesByNumber) {
    for (int i = 8; i <= 11; ++i) {
        const auto v = static_cast<std::uint16_t>(i);
        write_image("slice_" + std::to_string(i) + ".png", {{v, v, v, v}});
    }
    for (const auto& path : {folder_.string(), file("slice_%d.png")}) {
        const auto volume = load_volume(path);
        ASSERT_EQ(volume.geometry.dims, glm::ivec3(2, 2, 4));
        for (int z = 0; z < 4; ++z)
            EXPECT_EQ(volume.at(0, 0, z), static_cast<float>(8 + z));
    }
    EXPECT_THAT(refusal(file("other_%d.png")), HasSubstr("no file matches"));
    EXPECT_THAT(refusal(file("slice_%s.png")), HasSubstr("pattern"));
    write_image("slice_12.png", {{1, 1}});
    EXPECT_THAT(refusal(folder_.string()), HasSubstr("slice_12.png"));
    fs::remove(file("slice_12.png"));
    fs::remove(file("slice_10.png"));
    EXPECT_THAT(refusal(folder_.string()), AllOf(HasSubstr("missing"), HasSubstr("slice_11.png")));
    write_image("odd.png", {{1, 1, 1, 1}});
    EXPECT_THAT(refusal(folder_.string()), HasSubstr("odd.png"));
}

}  // namespace
