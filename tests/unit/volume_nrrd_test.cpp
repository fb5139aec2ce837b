// NRRD: place, units and values from the header; Slicer's segmentations; refusals.
#include <zlib.h>

#include <array>

#include "engine/volume/filters.h"
#include "tests/unit/volume_test_files.h"

namespace {

using namespace volume_test;
using edgesplat::load_volume;
using edgesplat::Volume;
using testing::AllOf;
using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

class NrrdFiles : public FolderTest {
  protected:
    /// A raw file of 2 x 2 x 2 bytes 1 to 8 with further fields.
    std::string nrrd(const std::string& fields, const std::string& name = "a.nrrd") const {
        return write(name, "NRRD0005\ntype: uint8\ndimension: 3\nsizes: 2 2 2\nencoding: raw\n" + fields +
                               "\n\1\2\3\4\5\6\7\10");
    }
    std::string with(const std::string& head, const std::string& data) const {
        return write("w.nrrd", "NRRD0005\n" + head + "\n" + data);
    }
};

glm::dmat3 axes_of(const Volume& volume) {
    return volume.geometry.index_to_world_axes;
}

TEST_F(NrrdFiles, SpacesAreComparedWhole) {
    const std::string rest = "space directions: (2,0,0) (0,3,0) (0,0,4)\nspace origin: (10,20,30)\n";
    struct Case {
        const char* space;
        glm::dvec3 signs;
        bool patient;
    };
    for (const Case& c :
         {Case{"right-anterior-superior", {-1, -1, 1}, true}, Case{"RAS", {-1, -1, 1}, true},
          Case{"left-anterior-superior", {1, -1, 1}, true}, Case{"Left Anterior Superior", {1, -1, 1}, true},
          Case{"left-posterior-superior", {1, 1, 1}, true}, Case{"lps", {1, 1, 1}, true},
          Case{"scanner-xyz", {1, 1, 1}, false}, Case{"3D-right-handed", {1, 1, 1}, false},
          Case{"3D-left-handed", {1, 1, 1}, false}}) {
        const Volume volume = load_volume(nrrd("space: " + std::string(c.space) + "\n" + rest));
        EXPECT_EQ(volume.in_patient, c.patient) << c.space;
        EXPECT_EQ(axes_of(volume) * glm::dvec3(1), glm::dvec3(2, 3, 4) * c.signs) << c.space;
        EXPECT_EQ(volume.geometry.origin, glm::dvec3(10, 20, 30) * c.signs) << c.space;
        EXPECT_EQ(volume.geometry_source, "space directions");
    }
    const Volume timed =
        load_volume(nrrd("space: LAST\nspace directions: (2,0,0,0) (0,3,0,0) (0,0,4,0)\nspace origin: (1,1,1,0)\n"));
    EXPECT_TRUE(timed.in_patient);
    EXPECT_EQ(timed.geometry.origin, glm::dvec3(1, -1, 1));
    EXPECT_THAT(refusal(nrrd("space: right-left-up\n" + rest)), HasSubstr("'right-left-up' is no known space"));
    EXPECT_THAT(refusal(nrrd("space: LPS\nspace directions: (1,0) (0,1) (1,1)\n")), HasSubstr("2 components"));
    const Volume undirected = load_volume(nrrd("space: LPS\nspacings: 1 2 3\n"));
    EXPECT_FALSE(undirected.in_patient);
    EXPECT_THAT(undirected.warnings, Contains(HasSubstr("no 'space directions'")));
}

TEST_F(NrrdFiles, UnitsBecomeMillimetres) {
    const std::string place = "space dimension: 3\nspace directions: (1,0,0) (0,1,0) (0,0,1)\nspace origin: (1,2,3)\n";
    const Volume microns = load_volume(nrrd(place + "space units: \"um\" \"um\" \"um\"\n"));
    EXPECT_EQ(microns.geometry.spacing(), glm::dvec3(1e-3));
    EXPECT_EQ(microns.geometry.origin, glm::dvec3(1e-3, 2e-3, 3e-3));
    EXPECT_EQ(microns.length_unit, "um");
    const Volume mixed = load_volume(nrrd(place + "space units: \"mm\" \"cm\" \"m\"\n"));
    EXPECT_EQ(mixed.geometry.spacing(), glm::dvec3(1, 10, 1000));
    const Volume axis_units = load_volume(nrrd("spacings: 2 2 2\nunits: \"um\" \"mm\" \"cm\"\n"));
    EXPECT_EQ(axis_units.geometry.spacing(), glm::dvec3(2e-3, 2, 20));
    const Volume unknown = load_volume(nrrd("spacings: 2 2 2\nunits: \"pixel\" \"pixel\" \"pixel\"\n"));
    EXPECT_EQ(unknown.geometry.spacing(), glm::dvec3(2));
    EXPECT_THAT(unknown.warnings, ElementsAre(HasSubstr("'pixel' is no known length")));
}

TEST_F(NrrdFiles, AxisMinsAndMaxsDependOnCenters) {
    const std::string limits = "axis mins: -1 -1 -1\naxis maxs: 3 3 3\n";
    const Volume cells = load_volume(nrrd("centers: cell cell cell\n" + limits));
    EXPECT_EQ(cells.geometry.spacing(), glm::dvec3(2));
    EXPECT_EQ(cells.geometry.origin, glm::dvec3(0));
    const Volume nodes = load_volume(nrrd("centerings: node node node\n" + limits));
    EXPECT_EQ(nodes.geometry.spacing(), glm::dvec3(4));
    EXPECT_EQ(nodes.geometry.origin, glm::dvec3(-1));
    EXPECT_EQ(nodes.geometry_source, "axis mins and maxs");
    const Volume reversed = load_volume(nrrd("centers: node node node\naxis mins: 3 3 3\naxis maxs: -1 3.5 4\n"));
    EXPECT_EQ(reversed.geometry.index_to_world_axes[0], glm::dvec3(-4, 0, 0));
    EXPECT_EQ(reversed.geometry.origin.x, 3);
    EXPECT_THAT(load_volume(nrrd("spacings: 1 1 1\ncenters: cell cell cell\n" + limits)).warnings,
                Contains(HasSubstr("contradicts its axis mins")));
    const Volume none = load_volume(nrrd(""));
    EXPECT_EQ(none.geometry_source, "none: 1 mm assumed");
}

TEST_F(NrrdFiles, DecodesAllEncodings) {
    const std::string head = "type: short\ndimension: 3\nsizes: 2 2 1\n";
    const auto values = ElementsAre(-1, 2, 258, 4);
    EXPECT_THAT(load_volume(with(head + "encoding: ascii\n", "-1 2,\n258 , 4.0")).values, values);
    EXPECT_THAT(load_volume(with(head + "encoding: hex\nendian: big\n", "ffff 0002\n010 2 0004")).values, values);
    EXPECT_THAT(load_volume(with(head + "encoding: raw\nendian: big\n", {"\xff\xff\0\2\1\2\0\4", 8})).values, values);
    EXPECT_THAT(load_volume(write("crlf.nrrd",
                                  "NRRD0001\r\ntype: uchar\r\n# a: b\r\ndimension: 3\r\nsizes: 2 2 1\r\n"
                                  "encoding: raw\r\n\r\nabcd"))
                    .values,
                ElementsAre(97, 98, 99, 100));
    EXPECT_THAT(refusal(with(head + "encoding: ascii\n", "1 2 3")), HasSubstr("truncated"));
    EXPECT_THAT(refusal(with(head + "encoding: ascii\n", "1 2 3 70000")),
                HasSubstr("'70000', expected numbers of type"));
    EXPECT_THAT(refusal(with(head + "encoding: ascii\n", "1 2 3 4.5")), HasSubstr("'4.5'"));
    EXPECT_THAT(refusal(with(head + "encoding: hex\nendian: big\n", "ffff0002010z0004")), HasSubstr("hexadecimal"));
    EXPECT_THAT(refusal(with(head + "encoding: zrl\n", "")), HasSubstr("'zrl', expected raw"));
    EXPECT_THAT(refusal(with(head + "encoding: raw\n", "12345678")), HasSubstr("'endian'"));
    const Volume nans =
        load_volume(with("type: float\ndimension: 3\nsizes: 2 2 1\nencoding: text\n", "nan 1e-3 -inf 1e400"));
    EXPECT_EQ(nans.non_finite_count, 3U);
}

TEST_F(NrrdFiles, ChoosesComponentAndFrameTogether) {
    std::string data;
    for (int i = 0; i < 32; ++i)
        data += static_cast<char>(i);
    const std::string head = "type: uchar\ndimension: 5\nsizes: 2 2 2 2 2\nencoding: raw\n";
    const std::string file = with(head + "kinds: vector domain domain domain time\n", data);
    EXPECT_THAT(load_volume(file, {.component = 1, .frame = 1}).values, ElementsAre(17, 19, 21, 23, 25, 27, 29, 31));
    EXPECT_THAT(refusal(file, {.component = 1}), HasSubstr("--frame 0..1"));
    EXPECT_THAT(
        load_volume(with(head + "kinds: domain list domain time domain\n", data), {.component = 1, .frame = 0}).values,
        ElementsAre(2, 3, 6, 7, 18, 19, 22, 23));
    EXPECT_THAT(refusal(with(head + "kinds: time time domain domain domain\n", data)),
                AllOf(HasSubstr("5 axes"), HasSubstr("both frames")));
    EXPECT_THAT(refusal(with(head + "kinds: RGB-color domain domain domain time\n", data)),
                HasSubstr("kind RGB-color has 3 samples, not 2"));
    const std::string colour(2187, '\0');
    EXPECT_THAT(refusal(with("type: uchar\ndimension: 4\nsizes: 3 9 9 9\nencoding: raw\n", colour)),
                AllOf(HasSubstr("colour or space"), HasSubstr("--frame 0..8")));
}

TEST_F(NrrdFiles, RefusesHeadersThatContradict) {
    const std::pair<const char*, const char*> cases[] = {
        {"spacings: 1 nan 1\n", "spacing of axis 1 is unknown; give --spacing"},
        {"spacings: 1 0 1\n", "'spacings': 0 for axis 1"},
        {"spacings: 1 -2 1\n", "'spacings': -2 for axis 1"},
        {"spacings: 1 inf 1\n", "infinite"},
        {"spacings: 1 1\n", "2 values, expected 3"},
        {"spacings: 1 1 1\nspacings: 1 1 2\n", "occurs twice"},
        {"space dimension: 3\nspace directions: (0,0,0) (0,1,0) (0,0,1)\n", "axis 0 has no length"},
        {"space dimension: 3\nspace directions: (1,0,0) (0,nan,0) (0,0,1)\n", "axis 1 is not a number"},
        {"space dimension: 3\nspace directions: (1,0,0) (1,0,0) (0,0,1)\n", "lie in one plane"},
        {"space dimension: 3\nspace directions: (1,0,0) (0,1,0) (0,0,1\n", "no ')'"},
        {"axis mins: 1 1 1\naxis maxs: 1 2 2\n", "axis 0 has no length"},
        {"byte skip: -1\nline skip: x\n", "'x' is not a whole number"},
        {"byte skip: 4\n", "truncated"},
        {"byte skip: 9223372036854775807\n", "2^40"},
        {"kinds: domain domain colour\n", "'colour' is no kind"},
        {"centers: cell cell side\n", "'side', expected cell or node"},
        {"data file: a.nrrd\n", "the header itself"},
        {"data file: missing.raw\n", "missing.raw does not exist"},
        {"hello\n", "neither 'field: value'"},
        {"space dimension: 3\nspace directions: (1,0,0) (0,1,0) (0,0,1)\nspacings: nan 2 nan\n",
         "'spacings': axis 1 has a number and one of 'space directions'"},
        {"space dimension: 3\nspace directions: (1,0,0) (0,1,0) (0,0,1)\naxis mins: 5 nan nan\n",
         "'axis mins': axis 0 has a number and one of 'space directions'"},
    };
    for (const auto& [fields, reason] : cases)
        EXPECT_THAT(refusal(nrrd(fields)), AllOf(HasSubstr("a.nrrd"), HasSubstr(reason))) << fields;
    EXPECT_EQ(load_volume(nrrd("spacings: 1 nan 1\n"), {.spacing = glm::dvec3(1, 2, 3)}).geometry.spacing(),
              glm::dvec3(1, 2, 3));
    EXPECT_THAT(refusal(with("type: block\ndimension: 3\nsizes: 2 2 2\nencoding: raw\n", "12345678")),
                HasSubstr("'block' cannot be read"));
    EXPECT_THAT(refusal(with("type: uchar\ndimension: 2\nsizes: 2 2 2\nencoding: raw\n", "12345678")),
                HasSubstr("'sizes': 3 values, expected 2"));
    EXPECT_EQ(
        load_volume(nrrd("space dimension: 3\nspace directions: (1,0,0) (0,2,0) (0,0,1)\nspacings: nan nan nan\n"))
            .geometry.spacing(),
        glm::dvec3(1, 2, 1));
    EXPECT_THAT(refusal(with("type: short\ndimension: 2\nsizes: 2 2\nencoding: raw\n", "12345678")),
                HasSubstr("'endian': missing, expected little or big"));
    for (const char* cut : {"type: uchar\ndimension: 3", "type: short\ndimension: 3\nsizes: 2 2 2\nencoding: raw"})
        EXPECT_THAT(refusal(write("cut.nrrd", std::string("NRRD0005\n") + cut)),
                    HasSubstr("truncated: its NRRD header does not end with an empty line"));
    EXPECT_THAT(load_volume(nrrd("space:=LPS\nfoo: bar\n")).warnings,
                ElementsAre(HasSubstr("'space:='"), HasSubstr("'foo: bar' is no field")));
    EXPECT_THAT(load_volume(write("long.nrrd", content_of(nrrd("")) + std::string(17, '9'))).warnings,
                ElementsAre(HasSubstr("after")));
    EXPECT_THAT(load_volume(nrrd("old min: -3\nold max: 5.5\n")).notes, Contains(HasSubstr("-3 to 5.5 (old min")));
}

TEST_F(NrrdFiles, WarnsOfValuesThatNoMeasurementHas) {
    const Volume volume =
        load_volume(with("type: double\ndimension: 3\nsizes: 2 2 1\nencoding: ascii\n", "1 -1e300 2e99 nan"));
    EXPECT_EQ(volume.non_finite_count, 2U);
    EXPECT_THAT(volume.warnings, Contains(HasSubstr("1 samples are above 1e+100 in magnitude")));
    EXPECT_NEAR(volume.in_file_unit(static_cast<double>(volume.max_value)), 2e99, 1e93);
}

TEST_F(NrrdFiles, ReadsSlicerSegmentations) {
    const std::string names =
        "Segment0_ID:=Segment_1\nSegment0_Name:=left: lung\nSegment0_Color:=1 0.5 0\nSegment0_LabelValue:=3\n"
        "Segment0_Layer:=0\nSegment1_Name:=empty\nSegment1_LabelValue:=9\nSegment1_Layer:=0\n"
        "Segment2_Name:=tumour\nSegment2_LabelValue:=1\nSegment2_Layer:=1\nSegment2_Color:=0 0 1\n";
    const std::string head = "type: uchar\nencoding: raw\n";
    const Volume one = load_volume(with(head + "dimension: 3\nsizes: 2 2 2\n" + names, {"\0\3\3\0\0\5\0\0", 8}));
    ASSERT_TRUE(one.labels);
    ASSERT_EQ(one.labels->labels.size(), 3U);
    EXPECT_EQ(one.labels->labels[0].name, "");
    EXPECT_EQ(one.labels->labels[1].name, "left: lung");
    EXPECT_EQ(one.labels->labels[1].value, 3.0F);
    EXPECT_NEAR(one.labels->labels[1].color->y, 0.21404, 1e-5);
    EXPECT_FALSE(one.labels->labels[2].color);
    EXPECT_THAT(one.notes, Contains(HasSubstr("without voxels: empty")));
    const std::string layers = with(head +
                                        "dimension: 4\nsizes: 2 2 2 2\nkinds: list domain domain domain\n"
                                        "space: LPS\nspace directions: none (1,0,0) (0,1,0) (0,0,1)\n" +
                                        names,
                                    {"\3\0\0\1\3\1\0\0\0\0\0\0\0\0\0\0", 16});
    EXPECT_THAT(refusal(layers), AllOf(HasSubstr("--component 0..1"), HasSubstr("0: left: lung, empty; 1: tumour")));
    const Volume second = load_volume(layers, {.component = 1});
    EXPECT_THAT(second.values, ElementsAre(0, 1, 1, 0, 0, 0, 0, 0));
    EXPECT_EQ(second.labels->labels[1].name, "tumour");
    // A deleted segment leaves a hole in the numbers.
    const Volume holed = load_volume(
        with(head + "dimension: 3\nsizes: 2 2 2\nSegment0_Name:=a\nSegment0_LabelValue:=3\n"
                    "Segment7_Name:=b\nSegment7_LabelValue:=5\nSegment12_Name:=c\nSegment12_LabelValue:=5\n",
             {"\0\3\3\0\0\5\0\0", 8}));
    EXPECT_EQ(holed.labels->labels[1].name, "a");
    EXPECT_EQ(holed.labels->labels[2].name, "c");
    EXPECT_THAT(holed.warnings, ElementsAre(HasSubstr("'b' and 'c' have the same LabelValue 5")));
}

TEST_F(NrrdFiles, KeepsLargeIdsWithTheirNames) {
    const Volume volume =
        load_volume(with("type: unsigned long long\ndimension: 3\nsizes: 2 2 1\nencoding: ascii\n"
                         "Segment0_Name:=area\nSegment0_LabelValue:=312782546\n",
                         "0 312782546 312782550 18446744073709551615"));
    ASSERT_TRUE(volume.labels);
    EXPECT_THAT(volume.values, ElementsAre(0, 1, 2, 3));
    EXPECT_EQ(volume.labels->labels[1].name, "area");
    EXPECT_EQ(volume.labels->number_of(volume.labels->labels[3]), "18446744073709551615");
    // The checksum is that of the numbers, not of their ranks.
    const auto sum_of = [&](std::int64_t last) {
        return samples_crc32(load_volume(with("type: longlong\ndimension: 3\nsizes: 2 2 1\nencoding: ascii\n",
                                              fmt::format("0 312782546 312782550 {}", last))));
    };
    const std::array<std::int64_t, 4> numbers{0, 312782546, 312782550, 312782551};
    EXPECT_EQ(sum_of(312782551), crc32(0, reinterpret_cast<const Bytef*>(numbers.data()), sizeof numbers));
    EXPECT_NE(sum_of(312782551), sum_of(312782552));
}

TEST_F(NrrdFiles, ReadsFilesThatAreGzipAsAWhole) {
    // gzip of "NRRD0001\ntype: uchar\ndimension: 3\nsizes: 2 2 1\nencoding: raw\n\nabcd"
    const unsigned char packed[] = {0x1f, 0x8b, 0x08, 0x00, 0x00, 0x00, 0x00, 0x00, 0x02, 0x03, 0xf3, 0x0b, 0x0a, 0x72,
                                    0x31, 0x30, 0x30, 0x30, 0xe4, 0x2a, 0xa9, 0x2c, 0x48, 0xb5, 0x52, 0x28, 0x4d, 0xce,
                                    0x48, 0x2c, 0xe2, 0x4a, 0xc9, 0xcc, 0x4d, 0xcd, 0x2b, 0xce, 0xcc, 0xcf, 0xb3, 0x52,
                                    0x30, 0xe6, 0x2a, 0xce, 0xac, 0x4a, 0x2d, 0xb6, 0x52, 0x30, 0x02, 0x42, 0x43, 0xae,
                                    0xd4, 0xbc, 0xe4, 0xfc, 0x94, 0xcc, 0xbc, 0x74, 0x2b, 0x85, 0xa2, 0xc4, 0x72, 0x2e,
                                    0xae, 0xc4, 0xa4, 0xe4, 0x14, 0x00, 0x54, 0x13, 0xff, 0xea, 0x42, 0x00, 0x00, 0x00};
    const std::string bytes(reinterpret_cast<const char*>(packed), sizeof(packed));
    EXPECT_THAT(load_volume(write("a.nrrd.gz", bytes)).values, ElementsAre(97, 98, 99, 100));
    EXPECT_THAT(refusal(write("b.nrrd.gz", bytes.substr(0, 60))),
                AllOf(HasSubstr("b.nrrd.gz"), HasSubstr("truncated")));
}

TEST_F(NrrdFiles, KnownCases) {
    if (data("").empty() || !fs::is_directory(data("odd/cases/nrrd"))) GTEST_SKIP() << "needs EDGESPLAT_DATA";
    for (const char* name : {"las.nrrd", "lps.nrrd"}) {
        const Volume volume = load_volume(data(std::string("odd/cases/nrrd/") + name));
        EXPECT_TRUE(volume.in_patient);
        EXPECT_LT(glm::length(volume.geometry.origin - glm::dvec3(-30.2, -32.4, -36.2)), 1e-12) << name;
        for (int axis = 0; axis < 3; ++axis)
            EXPECT_GT(volume.geometry.index_to_world_axes[axis][axis], 0) << name;
    }
    const Volume nan = load_volume(data("odd/cases/nrrd/nan.nrrd"));
    EXPECT_GT(nan.non_finite_count, 0U);
    EXPECT_TRUE(nan.no_data);
    const Volume annotation = load_volume(data("odd/cases/labels/annotation.nrrd"));
    ASSERT_TRUE(annotation.labels);
    EXPECT_EQ(annotation.labels->labels.size(), 7U);
    EXPECT_EQ(annotation.labels->number_of(annotation.labels->labels[6]), "312782558");
    EXPECT_EQ(load_volume(data("odd/cases/labels/cells300.nrrd")).max_value, 300.0F);
}

}  // namespace
