// MetaImage, GIPL and --raw: place, units and values from the header; refusals. See also
// tests/python/test_readers_meta.py.
#include <bit>
#include <cstring>

#include "tests/unit/volume_test_files.h"

namespace {

using namespace volume_test;
using edgesplat::load_volume;
using edgesplat::Volume;
using testing::AllOf;
using testing::AnyOf;
using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;

class MetaFiles : public FolderTest {
  protected:
    std::string meta(const std::string& keys) const {
        return write("a.mha", "NDims = 3\nDimSize = 2 2 2\nElementType = MET_UCHAR\n" + keys +
                                  "ElementDataFile = LOCAL\n\1\2\3\4\5\6\7\10");
    }
};

TEST_F(MetaFiles, PlaceComesFromRowsSpacingAndUnit) {
    const Volume volume =
        load_volume(meta("TransformMatrix = 0 1 0 0 0 -1 1 0 0\nElementSpacing = 2 3 4\nOffset = 10 20 30\n"
                         "DistanceUnits = um\nAnatomicalOrientation = ASR\n"));
    const auto& axes = volume.geometry.index_to_world_axes;
    EXPECT_LT(glm::length(axes[0] - glm::dvec3(0, 2e-3, 0)), 1e-15);
    EXPECT_LT(glm::length(axes[1] - glm::dvec3(0, 0, -3e-3)), 1e-15);
    EXPECT_LT(glm::length(axes[2] - glm::dvec3(4e-3, 0, 0)), 1e-15);
    EXPECT_LT(glm::length(volume.geometry.origin - glm::dvec3(1e-2, 2e-2, 3e-2)), 1e-15);
    EXPECT_EQ(volume.length_unit, "um");
    EXPECT_EQ(volume.geometry_source, "TransformMatrix");
    EXPECT_TRUE(volume.in_patient);
    EXPECT_FALSE(load_volume(meta("AnatomicalOrientation = ???\n")).in_patient);
    const Volume contradicting = load_volume(meta("AnatomicalOrientation = LPS\n"));
    EXPECT_FALSE(contradicting.in_patient);
    EXPECT_THAT(contradicting.warnings, ElementsAre(HasSubstr("not certain")));
    const Volume sized = load_volume(meta("ElementSize = 2 3 4\n"));
    EXPECT_EQ(sized.geometry.spacing(), glm::dvec3(2, 3, 4));
    EXPECT_EQ(sized.geometry_source, "ElementSize");
}

TEST_F(MetaFiles, ValuesAreScaled) {
    EXPECT_THAT(
        load_volume(meta("ElementToIntensityFunctionSlope = 2\nElementToIntensityFunctionOffset = -1\n")).values,
        ElementsAre(1, 3, 5, 7, 9, 11, 13, 15));
    const std::string text =
        "NDims: 3\nDimSize: 2 2 1\nElementType: MET_SHORT\nBinaryData: False\n"
        "ElementDataFile: LOCAL\n1 -2\n3 4\n";
    EXPECT_THAT(load_volume(write("t.mha", text)).values, ElementsAre(1, -2, 3, 4));
    write("a.raw", "12345678");
    const Volume late = load_volume(write("late.mhd",
                                          "NDims = 3\nDimSize = 2 2 2\nElementType = MET_UCHAR\n"
                                          "ElementDataFile = a.raw\nElementSpacing = 2 2 2\n"));
    EXPECT_THAT(late.warnings, ElementsAre(HasSubstr("have no effect")));
}

TEST_F(MetaFiles, RefusesHeadersThatContradict) {
    const std::pair<const char*, const char*> cases[] = {
        {"ElementSpacing = 1 0 1\n", "expected a length above 0"},
        {"ElementSpacing = 1 nan 1\n", "is not a number"},
        {"HeaderSize = 3\n", "points into the header"},
        {"TransformMatrix = 0 0 0 0 0 0 0 0 0\n", "spacing of axis 0 is 0"},
        {"ElementToIntensityFunctionSlope = nan\n", "is not a number"},
        {"ObjectType = Tube\n", "expected Image"},
        {"DimSize = 2 2 3\n", "occurs twice"},
        {"ElementByteOrderMSB = True\nelementtype = MET_UCHAR\nNDims = 4\n", "occurs twice"},
    };
    for (const auto& [keys, reason] : cases)
        EXPECT_THAT(refusal(meta(keys)), AllOf(HasSubstr("a.mha"), HasSubstr(reason))) << keys;
    EXPECT_THAT(
        refusal(write("a.mha", "ElementDataFile = LOCAL\nNDims = 3\nDimSize = 2 2 2\nElementType = MET_UCHAR\n")),
        HasSubstr("NDims: missing before ElementDataFile, which must be the last key"));
}

TEST_F(MetaFiles, GiplTakesVoxelDimsAndOrigin) {
    std::string head(256, '\0');
    const auto put = [&](std::size_t at, auto value) {
        char raw[sizeof(value)];
        std::memcpy(raw, &value, sizeof(value));
        for (std::size_t i = 0; i < sizeof(value); ++i)
            head[at + i] = raw[sizeof(value) - 1 - i];
    };
    for (std::size_t i = 0; i < 3; ++i) {
        put(2 * i, std::uint16_t{2});
        put(10 + 4 * i, 0.5F * static_cast<float>(i + 1));
        put(204 + 8 * i, 10.0 * static_cast<double>(i));
    }
    put(8, std::uint16_t{8});
    put(252, std::uint32_t{719555000});
    const std::string voxels = "\1\2\3\4\5\6\7\10";
    const Volume volume = load_volume(write("a.gipl", head + voxels));
    EXPECT_EQ(volume.geometry.spacing(), glm::dvec3(0.5, 1, 1.5));
    EXPECT_EQ(volume.geometry.origin, glm::dvec3(0, 10, 20));
    EXPECT_EQ(volume.values[7], 8.0F);
    EXPECT_THAT(refusal(write("b.gipl", head + voxels.substr(1))), HasSubstr("truncated"));
    put(10, 0.0F);
    EXPECT_THAT(refusal(write("c.gipl", head + voxels)), HasSubstr("expected a length above 0"));
    put(252, std::uint32_t{1});
    EXPECT_THAT(refusal(write("d.gipl", head + voxels)), HasSubstr("not a GIPL file"));
}

TEST_F(MetaFiles, RawTakesLargeIds) {
    std::string bytes(32, '\0');
    const std::uint64_t ids[] = {0, 312782546, 312782550, 9007199254740993};
    std::memcpy(bytes.data(), ids, sizeof(ids));
    const Volume volume = load_volume(write("a.raw", bytes), {.raw = "2x2x1:uint64:little:1,1,1"});
    EXPECT_THAT(volume.values, ElementsAre(0, 1, 2, 3));
    ASSERT_TRUE(volume.labels);
    EXPECT_EQ(volume.labels->number_of(volume.labels->labels[3]), "9007199254740993");
    EXPECT_EQ(volume.geometry_source, "--raw");
    for (const char* wrong :
         {"2x2x1:uint64:little:nan,1,1", "2x2x1:uint64:little:inf,1,1", "2x2x1:uint64:little:-1,1,1",
          "2x2x18446744073709551615:uint64:little", "2x2x1:uint64:little:1,1,1:18446744073709551615"})
        EXPECT_THAT(refusal(file("a.raw"), {.raw = wrong}), AnyOf(HasSubstr("--raw"), HasSubstr("a.raw: dims")))
            << wrong;
}

}  // namespace
