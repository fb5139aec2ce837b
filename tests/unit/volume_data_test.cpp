// Real volumes and unusual files of other projects, in the folder that EDGESPLAT_DATA names; skipped without it.
#include <algorithm>
#include <cmath>
#include <string>

#include "engine/volume/filters.h"
#include "volume_test_files.h"

namespace {

using namespace volume_test;
using edgesplat::load_volume;
using edgesplat::LoadOptions;
using edgesplat::Volume;
using testing::AllOf;
using testing::HasSubstr;

class Data : public testing::Test {
  protected:
    void SetUp() override {
        if (data("").empty()) GTEST_SKIP() << "EDGESPLAT_DATA is not set: no folder of real volumes";
    }
};

TEST_F(Data, VolumesHaveExpectedDimsSpacingAndRange) {
    struct Case {
        const char* path;
        glm::ivec3 dims;
        glm::dvec3 spacing;
        double low, high, mean;
        const char* type;
    };
    const Case cases[] = {
        {"hipip/ironProt.vtk", {68, 68, 68}, {1, 1, 1}, 0, 255, 13.1, "uint8"},
        {"hipip/hipip.nhdr", {68, 68, 68}, {1, 1, 1}, 0, 255, 13.1, "uint8"},
        {"hydrogen/hydrogenatom.nhdr", {128, 128, 128}, {1, 1, 1}, 0, 250, 2.86, "uint8"},
        {"nucleon/nucleon.nrrd", {41, 41, 41}, {1, 1, 1}, 0, 249, 39.4, "uint8"},
        {"cranium_ct/cranium.nhdr", {256, 256, 108}, {0.9570312, 0.9570312, 1.5}, -1024, 2986, -586, "int16"},
        {"cranium_ct/mask_0.nhdr", {257, 257, 109}, {0.9570312, 0.9570312, 1.5}, 0, 255, 16.85, "uint8"},
        {"headsq_ct/headsq.nhdr", {64, 64, 93}, {3.2, 3.2, 1.5}, 0, 3926, 508, "uint16"},
        {"chest_ct_dicom", {512, 512, 32}, {0.78125, 0.78125, 1}, -1000, 1766, -630, "uint16"},
        {"mrbrain_unc/brainsmall.nhdr", {128, 128, 84}, {1, 1, 1}, 0, 202, 14.0, "uint8"},
        {"colin27_mri/ch2.nii.gz", {181, 217, 181}, {1, 1, 1}, 0, 254, 44.6, "uint8"},
        {"colin27_large/ch2better.nii.gz", {301, 370, 316}, {0.5, 0.5, 0.5}, 0, 130, 34.7, "uint8"},
        {"frog_labels/frogtissue.mhd", {500, 470, 136}, {1, 1, 1.5}, 0, 29, 0.4, "uint8"},
        {"walnut_ct/walnut.nhdr", {128, 96, 114}, {0.015625, 0.015625, 0.015625}, 0, 22526, 2051, "uint16"},
        {"odd/meta_vtk/HeadMRVolume.mhd", {48, 62, 42}, {4, 4, 4}, 0, 255, 24.47, "uint8"},
        {"odd/nifti/anatomical.nii", {33, 41, 25}, {2, 2, 2}, -610, 30393, 8401.07, "int16"},
        {"odd/nifti/with_extension.nii.gz", {161, 191, 151}, {1, 1, 1}, 0, 1, 0.317, "uint8"},
        {"odd/nifti/air.hdr.gz", {79, 67, 64}, {2.389754, 2.366486, 2.385232}, 0, 92.5539, 33.65, "float32"},
        {"odd/minc/small.mnc", {29, 28, 18}, {7, 8, 9}, 0.1185331, 92.8768997, 31.2128, "int16"},
        {"odd/minc/tiny.mnc", {20, 20, 10}, {2, 2, 2}, 0.2078431, 0.7490196, 0.6060, "uint8"},
        {"odd/minc/minc1-no-att.mnc", {20, 20, 10}, {1, 1, 1}, 0.2078431, 0.7490196, 0.6060, "uint8"},
        {"odd/dicom/MR_small.dcm", {64, 64, 1}, {0.3125, 0.3125, 0.8}, 127, 2145, 518.9, "int16"},
    };
    for (const auto& c : cases) {
        SCOPED_TRACE(c.path);
        const auto volume = load_volume(data(c.path));
        EXPECT_EQ(volume.geometry.dims, c.dims);
        EXPECT_LT(glm::length(volume.geometry.spacing() - c.spacing), 1e-5);
        EXPECT_NEAR(volume.min_value, c.low, 1e-4 * std::max(1.0, std::abs(c.low)));
        EXPECT_NEAR(volume.max_value, c.high, 1e-4 * std::max(1.0, std::abs(c.high)));
        EXPECT_NEAR(mean_of(volume), c.mean, std::max(0.05, 0.002 * std::abs(c.mean)));
        EXPECT_EQ(volume.stored_type, c.type);
        EXPECT_EQ(volume.non_finite_count, 0U);
    }
}

// The header states too few compressed bytes: a reader that trusts it leaves the last million voxels undefined.
TEST_F(Data, FrogIsComplete) {
    const auto volume = load_volume(data("frog_labels/frogtissue.mhd"));
    const auto label = std::count(volume.values.begin(), volume.values.end(), 13.0F);
    EXPECT_EQ(label, 440722);
    EXPECT_NEAR(mean_of(volume), 0.38421377, 1e-6);
}

TEST_F(Data, EqualFilesLoadIdentically) {
    const auto same = [](std::initializer_list<const char*> names) {
        const auto first = load_volume(data(*names.begin()));
        for (const char* name : names)
            EXPECT_EQ(load_volume(data(name)).checksum, first.checksum) << name;
    };
    const std::string ball = "odd/nrrd/BallBinary30x30x30";
    same({"odd/nrrd/BallBinary30x30x30.nrrd", "odd/nrrd/BallBinary30x30x30.nhdr", "odd/nrrd/BallBinary30x30x30_gz.nrrd",
          "odd/nrrd/BallBinary30x30x30_bz2.nrrd", "odd/nrrd/BallBinary30x30x30_gz_lineskip.nrrd",
          "odd/nrrd/BallBinary30x30x30_gz_byteskip_minus_one.nrrd",
          "odd/nrrd/BallBinary30x30x30_byteskip_minus_one.nhdr",
          "odd/nrrd/BallBinary30x30x30_byteskip_minus_one_nifti.nhdr", "odd/nrrd/BallBinary30x30x30.nii.gz"});
    same({"odd/nifti/big.nii.gz", "odd/nifti/little.nii.gz"});
    same({"odd/dicom/MR_small.dcm", "odd/dicom/MR_small_bigendian.dcm", "odd/dicom/MR_small_implicit.dcm"});
    same({"odd/nifti/air.hdr.gz", "odd/nifti/air.img.gz"});
    same({"hipip/ironProt.vtk", "hipip/hipip.nhdr"});
    const auto values = load_volume(data(ball + ".nrrd")).values;
    EXPECT_TRUE(std::all_of(values.begin(), values.end(), [](float v) { return v == 0.0F || v == 257.0F; }));
    EXPECT_EQ(load_volume(data(ball + ".raw"), {.raw = "30x30x30:int16:little"}).values, values);
}

// The header has no byte skip, so the data begin with the NIfTI header. It is read as stated, with a note.
TEST_F(Data, ReadsNrrdThatPointsIntoNifti) {
    const auto volume = load_volume(data("odd/nrrd/BallBinary30x30x30_nifti.nhdr"));
    EXPECT_EQ(volume.min_value, -16512.0F);
    EXPECT_EQ(volume.max_value, 22850.0F);
    ASSERT_FALSE(volume.notes.empty());
    EXPECT_THAT(volume.notes[0], HasSubstr("byte skip"));
}

TEST_F(Data, CountsNonFiniteSamples) {
    const auto volume = load_volume(data("odd/nifti/resampled_anat_moved.nii"));
    EXPECT_EQ(volume.non_finite_count, 153U);
    EXPECT_NEAR(volume.min_value, 409.3004, 1e-3);
}

TEST_F(Data, SelectsFramesAndComponents) {
    const auto functional = data("timeseries/functional.nii");
    EXPECT_THAT(refusal(functional), AllOf(HasSubstr("functional.nii"), HasSubstr("--frame 0..19")));
    float low = INFINITY, high = -INFINITY;
    for (int frame = 0; frame < 20; ++frame) {
        const auto volume = load_volume(functional, {.frame = frame});
        EXPECT_EQ(volume.geometry.dims, glm::ivec3(17, 21, 3));
        low = std::min(low, volume.min_value);
        high = std::max(high, volume.max_value);
    }
    EXPECT_NEAR(low, 629.8, 0.1);
    EXPECT_NEAR(high, 5571.6, 0.1);
    EXPECT_THAT(refusal(functional, {.frame = 20}), HasSubstr("20 frames"));
    const auto run = data("timeseries/example4d.nii.gz");
    EXPECT_THAT(refusal(run), HasSubstr("--frame 0..1"));
    EXPECT_EQ(load_volume(run, {.frame = 1}).geometry.dims, glm::ivec3(128, 96, 24));
    EXPECT_THAT(refusal(data("odd/nifti/5D_small.nii")), HasSubstr("--component 0..2"));
    // ITK's buffers overflow with scaled vector data; the expected third component comes from the file's bytes.
    const auto vector = load_volume(data("odd/nifti/5D_small.nii"), {.component = 2});
    const double expected[] = {0.27826, 0.42996, 0.07968, 0.35273, 0.39135, 0.45478};
    ASSERT_EQ(vector.values.size(), 6U);
    for (std::size_t i = 0; i < 6; ++i)
        EXPECT_NEAR(vector.values[i], expected[i], 1e-5);
    EXPECT_EQ(load_volume(data("odd/nifti/5D_zeros.nii.gz"), {.component = 1}).max_value, 0.0F);
    EXPECT_NEAR(load_volume(data("odd/nrrd/test_simple4d_raw.nrrd")).values[0], 0.76903426, 1e-6);
}

// Two-dimensional files; see also Formats.ReadsTwoDimensionsAsOneSlice.
TEST_F(Data, ReadsFlatFiles) {
    const auto foot = load_volume(data("odd/meta_vtk/foot.mha"));
    EXPECT_EQ(foot.geometry.dims, glm::ivec3(256, 256, 1));
    EXPECT_THAT(foot.notes, testing::Contains(HasSubstr("3 spacings")));
    EXPECT_EQ(load_volume(data("odd/nrrd/beach.ascii.nhdr")).geometry.dims, glm::ivec3(100, 100, 1));
    const auto small = load_volume(data("odd/nrrd/test2d_ascii.nrrd"));
    for (std::size_t i = 0; i < 27; ++i)
        EXPECT_EQ(small.values[i], static_cast<float>(i + 1));
    EXPECT_EQ(load_volume(data("odd/nrrd/beach.nrrd"), {.component = 0}).geometry.dims, glm::ivec3(100, 100, 1));
}

TEST_F(Data, RefusesInvalidFiles) {
    const std::pair<const char*, const char*> cases[] = {
        {"odd/nrrd/BallBinary30x30x30_byteskip_minus_five.nhdr", "byte skip"},
        {"odd/nrrd/beach.nrrd", "colour or space"},
        {"odd/nrrd/test1d_ascii.nrrd", "1 axis"},
        {"odd/nrrd/test_customFields.nrrd", "1 axis"},
        {"odd/nrrd/beach.ascii", "unknown volume format"},
        {"odd/nrrd/BallBinary30x30x30.raw", "--raw"},
        {"odd/nifti/not-nifti.nii", "not a NIfTI"},
        {"odd/nifti/analyze.hdr", "analyze.img"},
        {"odd/nifti/nifti1.hdr", "nifti1.img"},
        {"odd/dicom/MR_truncated.dcm", "truncated"},
        {"odd/dicom", "MR_truncated.dcm"},
        {"headsq_ct", "no DICOM files"},
    };
    for (const auto& [path, reason] : cases)
        EXPECT_THAT(refusal(data(path)), AllOf(HasSubstr(data(path)), HasSubstr(reason)));
}

TEST_F(Data, ReadsVti) {
    for (const auto& [path, dims] : {std::pair{"hydrogen/hydrogen.vti", glm::ivec3(64)},
                                     std::pair{"odd/meta_vtk/vase_1comp.vti", glm::ivec3(115, 101, 75)}})
        EXPECT_EQ(load_volume(data(path)).geometry.dims, dims);
}

}  // namespace
