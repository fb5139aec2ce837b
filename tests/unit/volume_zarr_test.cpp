// Zarr hierarchies written here. The comparison with zarr-python is in tests/python/test_readers_zarr.py.
#include "volume_test_files.h"

namespace {

using namespace volume_test;
using edgesplat::load_volume;
using testing::HasSubstr;

class Zarr : public FolderTest {
  protected:
    /// A level of 2 x 2 x 3 voxels in chunks of 2 x 2 x 2: x + 10 y + 100 z, uint8; without its second chunk.
    void write_level(const std::string& name) const {
        fs::create_directories(folder_ / "a.zarr" / name / "0" / "0");
        write("a.zarr/" + name + "/.zarray",
              R"({"zarr_format": 2, "shape": [2, 2, 3], "chunks": [2, 2, 2], "dtype": "|u1", "compressor": null,
                  "fill_value": 7, "order": "C", "filters": null, "dimension_separator": "/"})");
        write("a.zarr/" + name + "/0/0/0", std::string("\x00\x01\x0a\x0b\x64\x65\x6e\x6f", 8));
    }
    void write_image(const std::string& transformations) const {
        write_level("0");
        write_level("1");
        write("a.zarr/.zgroup", R"({"zarr_format": 2})");
        write("a.zarr/.zattrs",
              R"({"multiscales": [{"version": "0.4", "axes": [)"
              R"({"name": "z", "type": "space", "unit": "micrometer"},)"
              R"({"name": "y", "type": "space", "unit": "millimeter"},)"
              R"({"name": "x", "type": "space", "unit": "micrometer"}], "datasets": [)"
              R"({"path": "0", "coordinateTransformations": [)" +
                  transformations +
                  R"(]},)"
                  R"({"path": "1", "coordinateTransformations": [{"type": "scale", "scale": [8, 8, 8]}]}]}]})");
    }
};

TEST_F(Zarr, ReadsPlaceFillValueAndLevels) {
    write_image(R"({"type": "scale", "scale": [3, 2, 1]}, {"type": "translation", "translation": [30, 20, 10]})");
    const auto volume = load_volume(file("a.zarr"));
    EXPECT_EQ(volume.geometry.dims, glm::ivec3(3, 2, 2));
    EXPECT_LT(glm::length(volume.geometry.spacing() - glm::dvec3(1e-3, 2, 3e-3)), 1e-12);
    EXPECT_LT(glm::length(volume.geometry.origin - glm::dvec3(10e-3, 20, 30e-3)), 1e-12);
    EXPECT_EQ(volume.at(1, 1, 1), 111);
    EXPECT_EQ(volume.at(2, 0, 0), 7);
    EXPECT_EQ(volume.geometry_source, "coordinateTransformations");
    EXPECT_THAT(volume.notes, testing::Contains(HasSubstr("1 of its 2 chunks are not stored")));
    EXPECT_EQ(load_volume(file("a.zarr"), {.level = 1}).geometry.spacing().y, 8);
    EXPECT_EQ(load_volume(file("a.zarr/1")).geometry.spacing().y, 8);
    EXPECT_THAT(refusal(file("a.zarr"), {.level = 2}), HasSubstr("--level 2: it has 2 levels"));
    EXPECT_THAT(refusal(write("a.nrrd", "NRRD0004\n"), {.level = 0}), HasSubstr("only OME-Zarr images have levels"));
}

TEST_F(Zarr, NamesTheFileOfTheAttributes) {
    write_image(R"({"type": "scale", "scale": [3, 0, 1]})");
    EXPECT_THAT(refusal(file("a.zarr")),
                HasSubstr("a.zarr/.zattrs: coordinateTransformations: 'scale' of axis y is 0"));
}

TEST_F(Zarr, LevelsAreOrderedBySize) {
    write_image(R"({"type": "scale", "scale": [1, 1, 1]})");
    write("a.zarr/0/.zarray",
          R"({"zarr_format": 2, "shape": [1, 1, 2], "chunks": [2, 2, 2], "dtype": "|u1", "compressor": null,
              "fill_value": 7, "order": "C", "filters": null, "dimension_separator": "/"})");
    EXPECT_EQ(load_volume(file("a.zarr")).geometry.dims, glm::ivec3(3, 2, 2));
    EXPECT_EQ(load_volume(file("a.zarr")).geometry.spacing().y, 8);
    EXPECT_EQ(load_volume(file("a.zarr"), {.level = 1}).geometry.dims, glm::ivec3(2, 1, 1));
    EXPECT_EQ(load_volume(file("a.zarr/0")).geometry.dims, glm::ivec3(2, 1, 1));
}

TEST_F(Zarr, KeepsNamesAndColoursOfLabels) {
    write_level("0");
    write("a.zarr/.zattrs", R"({"multiscales": [{"axes": ["z", "y", "x"], "datasets": [{"path": "0"}]}],
        "image-label": {"colors": [{"label-value": 11, "rgba": [255, 0, 0, 255]}],
                        "properties": [{"label-value": 11, "name": "liver"}]}})");
    const auto volume = load_volume(file("a.zarr"));
    ASSERT_NE(volume.labels, nullptr);
    ASSERT_EQ(volume.labels->labels.size(), 9U);
    const auto& liver = volume.labels->labels[4];  // 0, 1, 7, 10, 11, ...
    EXPECT_EQ(liver.id, 11U);
    EXPECT_EQ(liver.name, "liver");
    EXPECT_EQ(liver.color, glm::dvec3(1, 0, 0));
}

TEST_F(Zarr, RefusesWhatItCannotRead) {
    write_image(R"({"type": "scale", "scale": [3, 0, 1]})");
    EXPECT_THAT(refusal(file("a.zarr")), HasSubstr("'scale' of axis y is 0: expected a finite number that is not 0"));
    write_image(R"({"type": "rotation"})");
    EXPECT_THAT(refusal(file("a.zarr")), HasSubstr("type 'rotation': expected scale or translation"));
    write_image(R"({"type": "scale", "scale": [3, 2, 1]})");
    write("a.zarr/0/0/0/0", "1234567");
    EXPECT_THAT(refusal(file("a.zarr")), HasSubstr("7 bytes, expected 8: truncated"));
    write("a.zarr/0/.zarray", R"({"zarr_format": 2, "shape": [2, 2, 3], "chunks": [2, 2, 2], "dtype": "|u1",
        "compressor": {"id": "sz"}, "fill_value": 7, "order": "C", "filters": null})");
    EXPECT_THAT(refusal(file("a.zarr")), HasSubstr("compressor 'sz': expected blosc"));
}

}  // namespace
