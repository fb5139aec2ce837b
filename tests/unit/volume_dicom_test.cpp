// DICOM files of kinds that a series of single slices is not: phases, films, doses, segmentations, mosaics, and files
// that are no volumes. tests/python/test_readers_dicom.py compares places and values of many headers with pydicom.
#include <cmath>

#include "dicom_test_files.h"
#include "volume_test_files.h"

namespace {

using namespace volume_test;
using edgesplat::load_volume;
using testing::AllOf;
using testing::Contains;
using testing::HasSubstr;

class Dicom : public FolderTest {
  protected:
    static DicomData slice(double z, int value) {
        DicomData data = dicom_picture(2, 2, {value, value + 1, value + 2, value + 3});
        data.text(0x00200032, "DS", dicom_position(0, 0, z)).text(0x00200037, "DS", "1\\0\\0\\0\\1\\0");
        data.text(0x00280030, "DS", "1\\1");
        return data;
    }
    std::string write_data(const std::string& name, const DicomData& data) const { return write(name, data.file()); }
    static DicomData frames_of(int count) {
        std::vector<int> pixels;
        for (int i = 0; i < 4 * count; ++i)
            pixels.push_back(i);
        return dicom_picture(2, 2, pixels).text(0x00280008, "IS", std::to_string(count));
    }
    static DicomData frame_at(double z) {
        DicomData position, frame;
        position.text(0x00200032, "DS", dicom_position(0, 0, z));
        frame.sequence(0x00209113, {position});
        return frame;
    }
    static DicomData shared(const std::string& spacing = "1\\1") {
        DicomData orientation, measures, groups;
        orientation.text(0x00200037, "DS", "1\\0\\0\\0\\1\\0");
        measures.text(0x00280030, "DS", spacing);
        groups.sequence(0x00209116, {orientation}).sequence(0x00289110, {measures});
        return groups;
    }
};

TEST_F(Dicom, ReadsCasesOfOthers) {
    const std::string folder = data("odd/cases/dicom/");
    if (!fs::exists(folder) || data("").empty()) GTEST_SKIP() << "EDGESPLAT_DATA has no odd/cases/dicom";
    const auto ordered = load_volume(folder + "a_ordered.dcm");
    EXPECT_EQ(load_volume(folder + "c_random.dcm").checksum, ordered.checksum);
    EXPECT_EQ(ordered.geometry_source, "functional groups (0020,0032) per frame");
    EXPECT_THAT(refusal(folder + "e_two_phases.dcm"),
                AllOf(HasSubstr("temporal position index (0020,9128)"), HasSubstr("--frame 0..1 (0: 1, 1: 2)")));
    EXPECT_EQ(load_volume(folder + "e_two_phases.dcm", {.frame = 0}).checksum, ordered.checksum);
    const auto dose = load_volume(folder + "a_dose.dcm");
    EXPECT_EQ(dose.min_value, 0.0F);
    EXPECT_NEAR(dose.max_value, 3, 1e-6);
    EXPECT_EQ(dose.geometry_source, "GridFrameOffsetVector");
    EXPECT_LT(glm::length(dose.geometry.spacing() - glm::dvec3(1.6, 1.6, 2.8)), 1e-9);
}

TEST_F(Dicom, DividesPhasesInFoldersByWhatDiffers) {
    for (int phase = 0; phase < 3; ++phase)
        for (int z = 0; z < 3; ++z)
            write_data(fmt::format("{}{}", 2 - phase, z), slice(2 * z, 100 * phase + 10 * z)
                                                              .text(0x00181060, "DS", std::to_string(90 * phase + z))
                                                              .text(0x00200012, "IS", std::to_string(7 + phase)));
    EXPECT_THAT(refusal(folder_.string()),
                AllOf(HasSubstr("acquisition number (0020,0012)"), HasSubstr("--frame 0..2 (0: 7, 1: 8, 2: 9)")));
    for (int phase = 0; phase < 3; ++phase) {
        const auto volume = load_volume(folder_.string(), {.frame = phase});
        EXPECT_EQ(volume.at(0, 0, 2), static_cast<float>(100 * phase + 20));
    }
    EXPECT_THAT(refusal(folder_.string(), {.frame = 3}), HasSubstr("numbered from 0"));
    // With trigger times alone, which differ from slice to slice: the n-th of each place.
    for (int phase = 0; phase < 3; ++phase)
        for (int z = 0; z < 3; ++z)
            write_data(fmt::format("{}{}", 2 - phase, z),
                       slice(2 * z, 100 * phase + 10 * z).text(0x00181060, "DS", std::to_string(90 * phase + z)));
    EXPECT_THAT(refusal(folder_.string()),
                HasSubstr("trigger time (0018,1060); choose one with --frame 0..2 (0: 0 to 2"));
    EXPECT_EQ(load_volume(folder_.string(), {.frame = 1}).at(1, 0, 1), 111.0F);
}

TEST_F(Dicom, DividesByTwoAttributesTogether) {
    for (int echo = 0; echo < 2; ++echo)
        for (const char* part : {"M", "P"})
            for (int z = 0; z < 2; ++z)
                write_data(fmt::format("{}{}{}", echo, part, z),
                           slice(z, 100 * echo + (*part == 'P' ? 50 : 0) + 10 * z)
                               .text(0x00180081, "DS", echo == 0 ? "4.6" : "11")
                               .text(0x00080008, "CS", std::string("ORIGINAL\\PRIMARY\\") + part));
    EXPECT_THAT(refusal(folder_.string()),
                AllOf(HasSubstr("echo time (0018,0081) and image type (0008,0008)"), HasSubstr("--frame 0..3")));
    EXPECT_EQ(load_volume(folder_.string(), {.frame = 3}).at(0, 0, 1), 160.0F);
}

TEST_F(Dicom, DividesFramesOfAFileByWhatTheirGroupsSay) {
    struct Case {
        std::uint32_t group, tag;
        std::string_view vr, first, second, name;
    };
    using namespace std::string_view_literals;
    constexpr std::string_view kZero = "\0\0\0\0\0\0\0\0"sv, kOne = "\0\0\0\0\0\0\xf0\x3f"sv;
    const std::string along_z = std::string(kZero) + std::string(kZero) + std::string(kOne),
                      along_y = std::string(kZero) + std::string(kOne) + std::string(kZero);
    // Frames of two volumes in an order that says nothing: at z = 0 the second volume's comes first.
    const auto write_frames = [&](const Case& wanted) {
        std::vector<DicomData> frames;
        for (const auto& [z, second] :
             std::vector<std::pair<int, bool>>{{0, true}, {2, false}, {0, false}, {2, true}}) {
            DicomData item;
            if (wanted.tag != 0) item.raw(wanted.tag, wanted.vr, std::string(second ? wanted.second : wanted.first));
            frames.push_back(frame_at(z).sequence(wanted.group, {item}));
        }
        return write_data("a.dcm", frames_of(4).sequence(0x52009229, {shared()}).sequence(0x52009230, frames));
    };
    for (const Case& wanted : {
             Case{0x00209111, 0x00209156, "US", "\1\0"sv, "\2\0"sv, "frame acquisition number (0020,9156)"},
             Case{0x00209111, 0x00189151, "DT", "202001011200", "202001011300", "frame reference date and time"},
             Case{0x00209310, 0x0020930d, "FD", kZero, kOne, "time offset of the temporal position (0020,930d)"},
             Case{0x00189197, 0x00189090, "FD", along_z, along_y, "velocity encoding direction (0018,9090)"},
             Case{0x00189251, 0x00189257, "CS", "CONTROL ", "LABEL ", "arterial spin labelling (0018,9257)"},
             Case{0x00189341, 0x00189342, "CS", "NO", "YES ", "contrast agent administered (0018,9342)"},
             Case{0x00189314, 0x00181210, "SH", "B30 ", "B70 ", "convolution kernel (0018,1210)"},
         }) {
        const std::string path = write_frames(wanted);
        EXPECT_THAT(refusal(path), AllOf(HasSubstr(std::string(wanted.name)), HasSubstr("--frame 0..1")));
        const auto first = load_volume(path, {.frame = 0}), second = load_volume(path, {.frame = 1});
        EXPECT_EQ(first.at(0, 0, 0), 8.0F) << wanted.name;
        EXPECT_EQ(first.at(0, 0, 1), 4.0F) << wanted.name;
        EXPECT_EQ(second.at(0, 0, 0), 0.0F) << wanted.name;
        EXPECT_EQ(second.at(0, 0, 1), 12.0F) << wanted.name;
    }
    // The order of the frames in the file is no attribute.
    EXPECT_THAT(refusal(write_frames({.group = 0x00209111, .tag = 0}), {.frame = 0}),
                AllOf(HasSubstr("no attribute divides"), HasSubstr("frame 1, frame 3")));
}

TEST_F(Dicom, TimesDoNotDivideAgainstWhatFramesAre) {
    // Magnitude, then phase, or the other way round: the n-th by time is not one volume.
    for (int z = 0; z < 2; ++z)
        for (int n = 0; n < 4; ++n)
            write_data(fmt::format("{}{}", z, n),
                       slice(z, 100 * n + 10 * z)
                           .text(0x00080008, "CS", (n + z) % 2 == 0 ? "ORIGINAL\\PRIMARY\\M" : "ORIGINAL\\PRIMARY\\P")
                           .text(0x00080032, "TM", fmt::format("1200{}{}", z, n)));
    EXPECT_THAT(refusal(folder_.string()), AllOf(HasSubstr("no attribute divides"), HasSubstr("image type"),
                                                 HasSubstr("acquisition time (0008,0032)")));
}

TEST_F(Dicom, LeavesOutDuplicatesAndLocalizers) {
    for (int z = 0; z < 3; ++z)
        write_data(fmt::format("{}.dcm", z), slice(2 * z, 10 * z));
    write("copy.dcm", content_of(file("1.dcm")));
    write_data(
        "scout.dcm",
        slice(0, 0).text(0x00080008, "CS", "ORIGINAL\\PRIMARY\\LOCALIZER").text(0x00200037, "DS", "0\\1\\0\\0\\0\\-1"));
    const auto volume = load_volume(folder_.string());
    EXPECT_EQ(volume.geometry.dims, glm::ivec3(2, 2, 3));
    EXPECT_THAT(volume.warnings, Contains(AllOf(HasSubstr("Localizers"), HasSubstr("scout.dcm"))));
    EXPECT_THAT(volume.warnings, Contains(AllOf(HasSubstr("Duplicates"), HasSubstr("copy.dcm"))));
    // Another orientation without that name is a stack of its own.
    write_data("scout.dcm", slice(0, 0).text(0x00200037, "DS", "0\\1\\0\\0\\0\\-1"));
    EXPECT_THAT(refusal(folder_.string()),
                AllOf(HasSubstr("2 DICOM stacks"), HasSubstr("sagittal"), HasSubstr("--series")));
    EXPECT_EQ(load_volume(folder_.string(), {.series = "0"}).geometry.dims.z, 3);
}

TEST_F(Dicom, SlicesOfOtherPlacesAreNoPartOfAStack) {
    const auto write_slices = [&](std::uint32_t tag, std::string_view vr, const std::string& most,
                                  const std::string& last) {
        for (int z = 0; z < 4; ++z) {
            const std::string& value = z < 3 ? most : last;
            DicomData data = slice(2 * z, 10 * z);
            if (!value.empty()) data.text(tag, vr, value);
            write_data(fmt::format("{}.dcm", z), data);
        }
        return folder_.string();
    };
    struct Case {
        std::uint32_t tag;
        std::string_view vr;
        const char *most, *last, *shown;
    };
    for (const Case& c : {Case{0x00100020, "LO", "A", "B", "patient B"},
                          Case{0x00280004, "CS", "MONOCHROME2", "MONOCHROME1", "MONOCHROME1, 3.dcm"}}) {
        const std::string path = write_slices(c.tag, c.vr, c.most, c.last);
        EXPECT_THAT(refusal(path), AllOf(HasSubstr("2 DICOM stacks"), HasSubstr(c.shown)));
        EXPECT_EQ(load_volume(path, {.series = "0"}).geometry.dims.z, 3);
    }
    // A file that does not say it belongs to the others.
    EXPECT_EQ(load_volume(write_slices(0x00100020, "LO", "A", "")).geometry.dims.z, 4);
    EXPECT_THAT(load_volume(write_slices(0x00200052, "UI", "1.2.3", "1.2.4")).warnings,
                testing::ElementsAre(AllOf(HasSubstr("2 different FrameOfReferenceUIDs"), HasSubstr("3.dcm"))));
    EXPECT_THAT(load_volume(write_slices(0x00200052, "UI", "1.2.3", "")).warnings, testing::IsEmpty());
    EXPECT_THAT(
        load_volume(write_slices(0x00281054, "LO", "HU", "US")).warnings,
        testing::ElementsAre(HasSubstr("RescaleType (0028,1054) or Units (0054,1001): 0.dcm has HU, 3.dcm has US")));
    EXPECT_THAT(load_volume(write_slices(0x00281052, "DS", "-1024", "")).warnings,
                testing::ElementsAre(AllOf(HasSubstr("1 of 4 slices"), HasSubstr("such as 3.dcm"))));
}

TEST_F(Dicom, NamesSlicesThatAreNoDicomFiles) {
    for (int z = 0; z < 3; ++z)
        write_data(fmt::format("i{}.dcm", z), slice(2 * z, 10 * z));
    const std::string last = slice(6, 30).file();
    for (const auto& [content, shown] :
         std::vector<std::pair<std::string, std::string>>{{"", "i3.dcm (empty)"},
                                                          {last.substr(0, 100), "i3.dcm"},
                                                          {std::string(last.size(), '\0'), "i3.dcm"},
                                                          {"<html>404</html>", "i3.dcm"},
                                                          {"version https://git-lfs.github.com/spec/v1\n", "i3.dcm"}}) {
        write("i3.dcm", content);
        write("README", "text");
        write("notes.txt", "");
        const auto volume = load_volume(folder_.string());
        EXPECT_EQ(volume.geometry.dims.z, 3);
        EXPECT_THAT(volume.warnings, testing::ElementsAre(HasSubstr("named like them: " + shown + ".")));
        EXPECT_THAT(volume.notes, Contains("2 other files in the folder were ignored."));
    }
    // Names without extension, in a folder inside.
    fs::create_directory(folder_ / "series");
    for (int z = 0; z < 4; ++z)
        fs::rename(file(fmt::format("i{}.dcm", z)), folder_ / "series" / fmt::format("IM{}", z));
    fs::rename(file("README"), folder_ / "series" / "README");
    EXPECT_THAT(load_volume(folder_.string()).warnings, testing::ElementsAre(HasSubstr("named like them: IM3.")));
}

TEST_F(Dicom, NamesWhatIsNoVolume) {
    DicomData structures;
    structures.text(0x00080016, "UI", "1.2.840.10008.5.1.4.1.1.481.3").text(0x00080060, "CS", "RTSTRUCT");
    EXPECT_THAT(refusal(write_data("rs.dcm", structures)),
                HasSubstr("an RT structure set (contours), which is no volume"));
    for (int z = 0; z < 2; ++z)
        write_data(fmt::format("{}.dcm", z), slice(z, 0));
    EXPECT_THAT(load_volume(folder_.string()).warnings, Contains(HasSubstr("rs.dcm (an RT structure set (contours))")));
    DicomData report;
    report.text(0x00080016, "UI", "1.2.840.10008.5.1.4.1.1.88.22").text(0x00080060, "CS", "SR");
    EXPECT_THAT(refusal(write_data("sr.dcm", report)), HasSubstr("a structured report"));
    // A folder of folders, and a DICOMDIR.
    fs::create_directory(folder_ / "IMAGES");
    DicomData first, second, directory;
    for (int z = 0; z < 2; ++z)
        fs::rename(folder_ / fmt::format("{}.dcm", z), folder_ / "IMAGES" / fmt::format("im{}", z));
    fs::remove(folder_ / "rs.dcm");
    fs::remove(folder_ / "sr.dcm");
    first.text(0x00041500, "CS", "IMAGES\\IM0");
    second.text(0x00041500, "CS", "..\\..\\etc\\passwd");
    directory.text(0x00080016, "UI", "1.2.840.10008.1.3.10").sequence(0x00041220, {first, second});
    const auto from_list = load_volume(write_data("DICOMDIR", directory));
    EXPECT_EQ(from_list.geometry.dims.z, 1);
    EXPECT_THAT(from_list.warnings, Contains(HasSubstr("not there")));
    EXPECT_EQ(load_volume(folder_.string()).geometry.dims.z, 2);
}

TEST_F(Dicom, FilmsAreNoVolumes) {
    const auto film = write_data("film.dcm", frames_of(5));
    EXPECT_THAT(refusal(film), AllOf(HasSubstr("5 frames without positions"), HasSubstr("--frame 0..4"),
                                     HasSubstr("--spacing X Y Z")));
    EXPECT_EQ(load_volume(film, {.frame = 3}).at(0, 0, 0), 12.0F);
    const auto slices = load_volume(film, {.spacing = glm::dvec3(1, 2, 3)});
    EXPECT_EQ(slices.geometry.dims.z, 5);
    EXPECT_EQ(slices.geometry.spacing(), glm::dvec3(1, 2, 3));
    // One position and a spacing: slices, unless the frames follow in time.
    DicomData stack = frames_of(5).text(0x00200032, "DS", "1\\2\\3").text(0x00200037, "DS", "0\\1\\0\\0\\0\\1");
    stack.text(0x00180088, "DS", "2.5").text(0x00280030, "DS", "1\\1");
    const auto volume = load_volume(write_data("stack.dcm", stack));
    EXPECT_LT(glm::length(volume.geometry.index_to_world_axes[2] - glm::dvec3(2.5, 0, 0)), 1e-12);
    EXPECT_THAT(volume.geometry_source, HasSubstr("spacing tag (0018,0088)"));
    stack.raw(0x00280009, "AT", DicomData::integers({0x0018, 0x1063}, 2));
    EXPECT_THAT(refusal(write_data("stack.dcm", stack)), HasSubstr("without positions"));
    // Single pictures.
    fs::remove(film);
    fs::remove(file("stack.dcm"));
    for (int i = 0; i < 3; ++i)
        write_data(fmt::format("{}", i),
                   dicom_picture(2, 2, {i, i, i, i}).text(0x00200013, "IS", std::to_string(9 - i)));
    EXPECT_THAT(refusal(folder_.string()), HasSubstr("3 frames without positions"));
    EXPECT_EQ(load_volume(folder_.string(), {.spacing = glm::dvec3(1)}).at(0, 0, 0), 2.0F);
}

TEST_F(Dicom, RefusesHeadersThatContradictThemselves) {
    const auto enhanced = [&](DicomData file, std::vector<DicomData> frames) {
        return write_data("a.dcm", file.sequence(0x52009229, {shared()}).sequence(0x52009230, frames));
    };
    EXPECT_EQ(load_volume(enhanced(frames_of(2), {frame_at(3), frame_at(1)})).at(0, 0, 0), 4.0F);
    EXPECT_THAT(refusal(enhanced(frames_of(2), {frame_at(3)})), HasSubstr("5200,9230) have 1 frames"));
    EXPECT_THAT(refusal(enhanced(frames_of(4), {frame_at(0), frame_at(1), frame_at(2), frame_at(4)})),
                AllOf(HasSubstr("a slice may be missing"), HasSubstr("--resample")));
    EXPECT_EQ(
        load_volume(enhanced(frames_of(4), {frame_at(0), frame_at(1), frame_at(2), frame_at(4)}), {.resample = true})
            .geometry.dims.z,
        5);
    const auto refused = [&](const DicomData& data) { return refusal(write_data("b.dcm", data)); };
    EXPECT_THAT(refused(slice(0, 0).text(0x00280008, "IS", "9")), HasSubstr("NumberOfFrames (0028,0008) 9"));
    EXPECT_THAT(refused(frames_of(9).text(0x00280008, "IS", "2")), HasSubstr("the header is wrong"));
    EXPECT_THAT(refused(slice(0, 0).text(0x00280008, "IS", "1A")), HasSubstr("NumberOfFrames (0028,0008) is '1A'"));
    EXPECT_THAT(refused(slice(0, 0).text(0x00280030, "DS", "0\\1")), HasSubstr("PixelSpacing (0028,0030) is '0\\1'"));
    EXPECT_THAT(refused(slice(0, 0).text(0x00280030, "DS", "nan\\1")), HasSubstr("PixelSpacing"));
    EXPECT_THAT(refused(slice(0, 0).text(0x00200037, "DS", "1\\0\\0\\1\\0\\0")), HasSubstr("perpendicular"));
    EXPECT_THAT(refused(slice(0, 0).text(0x00281053, "DS", "0")), HasSubstr("RescaleSlope"));
    EXPECT_THAT(refused(slice(0, 0).u16(0x00280101, {17})), HasSubstr("BitsStored (0028,0101) is 17"));
    EXPECT_THAT(refused(slice(0, 0).without(0x00280010)), HasSubstr("no Rows (0028,0010)"));
    EXPECT_THAT(refused(frames_of(3)
                            .text(0x00200032, "DS", "0\\0\\5")
                            .text(0x00200037, "DS", "1\\0\\0\\0\\1\\0")
                            .text(0x3004000c, "DS", "7\\8\\9")),
                HasSubstr("begins with 7, expected 0, or the z of ImagePositionPatient (0020,0032), 5"));
}

TEST_F(Dicom, ChoosesAmongStacksOfOneFile) {
    const auto frame = [](double z, const char* stack) {
        DicomData content, groups = frame_at(z);
        content.text(0x00209056, "SH", stack);
        return groups.sequence(0x00209111, {content});
    };
    const auto path = write_data("a.dcm", frames_of(5)
                                              .sequence(0x52009229, {shared()})
                                              .sequence(0x52009230, {frame(0, "1"), frame(90, "2"), frame(1, "1"),
                                                                     frame(93, "2"), frame(2, "1")}));
    EXPECT_THAT(refusal(path), AllOf(HasSubstr("--series"), HasSubstr("stack 2"), HasSubstr("2 frames in 1 file")));
    EXPECT_EQ(load_volume(path, {.series = "0"}).geometry.dims.z, 3);
    EXPECT_EQ(load_volume(path, {.series = "1"}).geometry.spacing().z, 3);
}

TEST_F(Dicom, UltrasoundVolumesHavePlacesOfTheirOwn) {
    std::vector<DicomData> frames;
    for (const double z : {2.0, 0.0}) {
        DicomData position, frame;
        std::string three;
        for (const double number : {5.0, 6.0, z}) {
            DicomData one;
            three += one.f64(0x00209301, number).bytes().substr(8);
        }
        position.raw(0x00209301, "FD", three);
        frames.push_back(frame.sequence(0x0020930e, {position}));
    }
    DicomData groups = shared(), orientation;
    std::string six;
    for (const double number : {0.0, 1.0, 0.0, 1.0, 0.0, 0.0}) {
        DicomData one;
        six += one.f64(0x00209302, number).bytes().substr(8);
    }
    orientation.raw(0x00209302, "FD", six);
    groups.without(0x00209116).sequence(0x0020930f, {orientation});
    const auto volume =
        load_volume(write_data("a.dcm", frames_of(2).sequence(0x52009229, {groups}).sequence(0x52009230, frames)));
    EXPECT_EQ(volume.geometry.index_to_world_axes[2], glm::dvec3(0, 0, -2));
    EXPECT_EQ(volume.geometry.origin, glm::dvec3(5, 6, 2));
    EXPECT_FALSE(volume.in_patient);
}

TEST_F(Dicom, PaddingIsNoDataAndModalityTablesAreApplied) {
    const auto volume =
        load_volume(write_data("a.dcm", slice(0, -2).raw(0x00280120, "SS", DicomData::integers({-1}, 2))));
    EXPECT_EQ(volume.non_finite_count, 1U);
    EXPECT_EQ(volume.min_value, -2.0F);
    EXPECT_THAT(volume.notes, Contains(HasSubstr("PixelPaddingValue (0028,0120)")));
    DicomData table;
    table.u16(0x00283002, {3, 1, 16}).u16(0x00283006, {100, 200, 400});
    EXPECT_THAT(load_volume(write_data("b.dcm", slice(0, 0).sequence(0x00283000, {table}))).values,
                testing::ElementsAre(100, 100, 200, 400));
}

TEST_F(Dicom, SegmentsAreLabelsWithNamesAndColours) {
    const auto segment = [](int number, const std::string& name, const std::vector<int>& lab) {
        DicomData item;
        item.u16(0x00620004, {number}).text(0x00620005, "LO", name).u16(0x0062000d, lab);
        return item;
    };
    const auto frame = [](int number, double z) {
        DicomData identified, groups = frame_at(z);
        identified.u16(0x0062000b, {number});
        return groups.sequence(0x0062000a, {identified});
    };
    DicomData data = frames_of(3);
    data.text(0x00080016, "UI", "1.2.840.10008.5.1.4.1.1.66.4").text(0x00620001, "CS", "BINARY");
    data.u16(0x00280100, {1}).u16(0x00280101, {1}).u16(0x00280102, {0}).u16(0x00280103, {0});
    data.sequence(0x00620002, {segment(2, "liver", {65535, 32896, 32896}), segment(5, "spleen", {0, 32896, 32896})});
    data.sequence(0x52009229, {shared()}).sequence(0x52009230, {frame(5, 0), frame(2, 0), frame(2, 3)});
    // Frames of 4 bits follow each other without gaps: 5 has the first two pixels, 2 the first and fourth; then all.
    data.raw(0x7fe00010, "OB", std::string("\x93\x0f", 2));
    const auto path = write_data("seg.dcm", data);
    const auto volume = load_volume(path);
    EXPECT_EQ(volume.geometry.dims, glm::ivec3(2, 2, 2));
    EXPECT_THAT(volume.values, testing::ElementsAre(5, 5, 0, 2, 2, 2, 2, 2));
    ASSERT_TRUE(volume.labels);
    ASSERT_EQ(volume.labels->labels.size(), 3U);
    EXPECT_EQ(volume.labels->labels[1].name, "liver");
    EXPECT_EQ(volume.labels->labels[2].id, 5U);
    EXPECT_LT(glm::length(*volume.labels->labels[1].color - glm::dvec3(1)), 0.02);
    EXPECT_LT(glm::length(*volume.labels->labels[2].color), 0.02);
    EXPECT_THAT(volume.warnings, Contains(HasSubstr("Segments 2 and 5 overlap in 1 voxels")));
    EXPECT_THAT(load_volume(path, {.component = 0}).values, testing::ElementsAre(2, 0, 0, 2, 2, 2, 2, 2));
    EXPECT_THAT(refusal(path, {.component = 2}), HasSubstr("0: 2 (liver), 1: 5 (spleen)"));
    // Planes that are empty have no frames.
    data.sequence(0x52009230, {frame(5, 0), frame(2, 1), frame(2, 4)});
    const auto sparse = load_volume(write_data("seg.dcm", data));
    EXPECT_EQ(sparse.geometry.dims.z, 5);
    EXPECT_EQ(sparse.at(0, 0, 2), 0.0F);
    EXPECT_EQ(sparse.at(0, 0, 4), 2.0F);
    DicomData fractions = frames_of(1);
    fractions.text(0x00080016, "UI", "1.2.840.10008.5.1.4.1.1.66.4").text(0x00620001, "CS", "FRACTIONAL");
    fractions.u16(0x0062000e, {2}).sequence(0x00620002, {segment(2, "liver", {65535, 32896, 32896})});
    fractions.sequence(0x52009229, {shared()}).sequence(0x52009230, {frame(2, 0)});
    EXPECT_THAT(load_volume(write_data("fractions.dcm", fractions)).warnings,
                Contains(HasSubstr("1 stored fractions are above MaximumFractionalValue (0062,000e), which is 2")));
}

TEST_F(Dicom, MosaicsAreDivided) {
    std::vector<int> pixels;
    for (int i = 0; i < 16; ++i)
        pixels.push_back(i);
    DicomData data = dicom_picture(4, 4, pixels).text(0x00080008, "CS", "ORIGINAL\\PRIMARY\\M\\MOSAIC");
    data.text(0x00200032, "DS", "-10\\-20\\5")
        .text(0x00200037, "DS", "1\\0\\0\\0\\1\\0")
        .text(0x00280030, "DS", "2\\3");
    data.text(0x00180088, "DS", "4").u16(0x0019100a, {3});
    EXPECT_THAT(refusal(write_data("a.dcm", data)), AllOf(HasSubstr("mosaic of 3 slices"), HasSubstr("dcm2niix")));
    std::string csa = "SV10" + std::string("\x04\x03\x02\x01", 4) + DicomData::integers({1, 77}, 4);
    std::string tag = "SliceNormalVector";
    tag.resize(64, '\0');
    csa += tag + DicomData::integers({3, 0, 0, 3, 77}, 4);
    for (const char* number : {"0.0", "0.0", "-1.0"})
        csa += DicomData::integers({4, 4, 77, 4}, 4) + std::string(number).append(4, '\0').substr(0, 4);
    data.raw(0x00291010, "OB", csa);
    const auto volume = load_volume(write_data("a.dcm", data));
    EXPECT_EQ(volume.geometry.dims, glm::ivec3(2, 2, 3));
    // The normal points down: the first slice is the highest. Half the picture less half a tile is 1 pixel.
    EXPECT_LT(glm::length(volume.geometry.origin - glm::dvec3(-7, -18, -3)), 1e-9);
    EXPECT_THAT(volume.values, testing::ElementsAre(8, 9, 12, 13, 2, 3, 6, 7, 0, 1, 4, 5));
}

}  // namespace
