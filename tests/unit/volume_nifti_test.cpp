// Place and scale of NIfTI, MGH, MRC and NumPy files, written here byte by byte. tests/python/test_readers_*.py compare
// many more with readers that others wrote.
#include <bit>
#include <cstring>

#include "volume_test_files.h"

namespace {

using namespace volume_test;
using edgesplat::load_volume;
using edgesplat::Volume;
using testing::HasSubstr;

class Headers : public FolderTest {};

// A header of `size` bytes; fields are put in at their offsets.
struct HeaderBytes {
    std::string bytes;
    bool big = false;

    explicit HeaderBytes(std::size_t size, bool is_big = false) : bytes(size, '\0'), big(is_big) {}
    template <typename T>
    HeaderBytes& put(std::size_t at, std::initializer_list<T> values) {
        for (const T value : values) {
            std::memcpy(&bytes[at], &value, sizeof(T));
            if (big) std::reverse(&bytes[at], &bytes[at] + sizeof(T));
            at += sizeof(T);
        }
        return *this;
    }
    HeaderBytes& text(std::size_t at, std::string_view value) {
        bytes.replace(at, value.size(), value);
        return *this;
    }
};

// 2 x 3 x 4 voxels of uint8 from 0 to 23.
HeaderBytes small_nifti() {
    HeaderBytes header(352);
    header.put<std::int32_t>(0, {348}).put<std::int16_t>(40, {3, 2, 3, 4, 1, 1, 1, 1}).put<std::int16_t>(70, {2, 8});
    header.put<float>(76, {1, 1, 2, 3}).put<float>(108, {352, 1, 0}).text(123, "\2").text(344, "n+1");
    return header;
}
std::string counting(int count) {
    std::string data;
    for (int i = 0; i < count; ++i)
        data += static_cast<char>(i);
    return data;
}

void expect_axes(const Volume& volume, const glm::dmat3& axes, const glm::dvec3& origin, const char* source) {
    for (int axis = 0; axis < 3; ++axis)
        EXPECT_LT(glm::length(volume.geometry.index_to_world_axes[axis] - axes[axis]), 1e-6 * glm::length(axes[axis]))
            << axis;
    EXPECT_LT(glm::length(volume.geometry.origin - origin), 1e-6 * (1 + glm::length(origin)));
    EXPECT_EQ(volume.geometry_source, source);
}

TEST_F(Headers, NiftiPrefersItsSformInItsUnit) {
    HeaderBytes header = small_nifti();
    // Sheared, in micrometres.
    header.put<std::int16_t>(252, {1, 2}).put<float>(280, {1000, 500, 0, 7000, 0, 2000, 0, 0, 0, 0, 3000, -9000});
    header.text(123, "\3");
    const Volume volume = load_volume(write("a.nii", header.bytes + counting(24)));
    expect_axes(volume, {{-1, 0, 0}, {-.5, -2, 0}, {0, 0, 3}}, {-7, 0, -9}, "sform (code 2)");
    EXPECT_TRUE(volume.in_patient);
    EXPECT_EQ(volume.length_unit, "um");
    EXPECT_EQ(volume.values[23], 23.0F);
    // The qform, of the identity in um, is elsewhere.
    EXPECT_THAT(volume.notes, testing::Contains(HasSubstr("sform (code 2) is used; qform (code 1)")));
}

TEST_F(Headers, NiftiUsesItsQformOtherwise) {
    HeaderBytes header = small_nifti();
    // By 180 degrees around z; qfac -1. Slightly too long after rounding.
    header.put<std::int16_t>(252, {1, 0}).put<float>(256, {0, 0, 1.00001F, 10, 20, 30}).put<float>(76, {-1});
    header.put<float>(280, {NAN, NAN});  // not used
    const Volume volume = load_volume(write("a.nii", header.bytes + counting(24)));
    expect_axes(volume, {{1, 0, 0}, {0, 2, 0}, {0, 0, -3}}, {-10, -20, 30}, "qform (code 1)");
    EXPECT_TRUE(volume.in_patient);
}

TEST_F(Headers, NiftiWithoutCodesIsNotInThePatient) {
    const Volume volume = load_volume(write("a.nii", small_nifti().bytes + counting(24)));
    expect_axes(volume, {{1, 0, 0}, {0, 2, 0}, {0, 0, 3}}, {0, 0, 0}, "pixdim (sform and qform code 0)");
    EXPECT_FALSE(volume.in_patient);
}

TEST_F(Headers, NiftiScales) {
    const auto second = [&](float slope, float intercept) {
        return load_volume(write("a.nii", small_nifti().put<float>(112, {slope, intercept}).bytes + counting(24)))
            .values[1];
    };
    EXPECT_EQ(second(0, 100), 1.0F);
    EXPECT_EQ(second(NAN, 100), 1.0F);
    EXPECT_EQ(second(2, 100), 102.0F);
    EXPECT_THAT(refusal(write("a.nii", small_nifti().put<float>(112, {2, NAN}).bytes + counting(24))),
                HasSubstr("scl_inter"));
}

TEST_F(Headers, NiftiRefusesWhatContradictsItself) {
    const auto reason = [&](HeaderBytes header) { return refusal(write("a.nii", header.bytes + counting(24))); };
    EXPECT_THAT(reason(small_nifti().put<float>(108, {8})), HasSubstr("vox_offset 8 in its header points into"));
    EXPECT_THAT(reason(small_nifti().put<float>(84, {0})), HasSubstr("pixdim[2] in its header: 0"));
    EXPECT_THAT(reason(small_nifti().put<std::int16_t>(40, {9})), HasSubstr("9 axes"));
    EXPECT_THAT(reason(small_nifti().put<std::int16_t>(254, {1})), HasSubstr("one plane"));
    EXPECT_THAT(reason(small_nifti().put<std::int16_t>(70, {1, 1})), HasSubstr("1 bit"));
    EXPECT_THAT(reason(small_nifti().put<std::int16_t>(46, {5})), HasSubstr("truncated"));
    // Without vox_offset, the size of the file tells.
    EXPECT_EQ(load_volume(write("b.nii", small_nifti().put<float>(108, {0}).bytes + counting(24))).values[5], 5.0F);
    EXPECT_THAT(reason(small_nifti().put<float>(108, {0}).put<std::int16_t>(46, {3})), HasSubstr("vox_offset 0"));
}

TEST_F(Headers, CasesThatUsersReported) {
    if (data("").empty()) GTEST_SKIP() << "EDGESPLAT_DATA is not set: no folder of real volumes";
    const auto cases = [](const char* name) { return load_volume(data(std::string("odd/cases/nifti/") + name)); };
    if (!fs::exists(data("odd/cases/nifti"))) GTEST_SKIP() << "odd/cases is not in EDGESPLAT_DATA";
    const Volume sheared = cases("sheared_both.nii.gz");
    EXPECT_THAT(sheared.geometry_source, HasSubstr("sform"));
    EXPECT_NEAR(sheared.geometry.spacing().z, 2.52351, 1e-4);
    EXPECT_THAT(cases("affine_sform.nii.gz").geometry_source, HasSubstr("sform"));
    EXPECT_EQ(cases("a_slope0_inter100.nii").max_value, 1000.0F);
    EXPECT_EQ(cases("a_slope0_inter100.nii").min_value, 0.0F);
}

TEST_F(Headers, MghPlacesItsCenter) {
    HeaderBytes header(284, true);
    header.put<std::int32_t>(0, {1, 2, 3, 4, 2, 0}).put<std::int16_t>(28, {1}).put<float>(30, {1, 2, 3});
    header.put<float>(42, {-1, 0, 0, 0, 0, -1, 0, 1, 0}).put<float>(78, {10, 20, 30});
    const std::string path = write("a.mgh", header.bytes + counting(48));
    EXPECT_THAT(refusal(path), HasSubstr("--frame 0..1"));
    const Volume volume = load_volume(path, {.frame = 1});
    EXPECT_EQ(volume.values[0], 24.0F);
    // Voxel (1, 1.5, 2) is at the centre.
    const glm::dmat3 axes({1, 0, 0}, {0, 0, -2}, {0, -3, 0});
    expect_axes(volume, axes, glm::dvec3(-10, -20, 30) - axes * glm::dvec3(1, 1.5, 2), "Mdc and c_ras (goodRASFlag 1)");
    EXPECT_TRUE(volume.in_patient);
    const Volume placeless =
        load_volume(write("b.mgh", header.put<std::int16_t>(28, {0}).bytes + counting(48)), {.frame = 0});
    EXPECT_EQ(placeless.geometry_source, "none: 1 mm assumed");
    EXPECT_FALSE(placeless.in_patient);
}

TEST_F(Headers, MrcPermutesItsAxes) {
    HeaderBytes header(1024);
    header.put<std::int32_t>(0, {2, 3, 4, 0, 5, 0, 0, 8, 4, 6}).put<float>(40, {16, 4, 12, 90, 90, 90});
    header.put<std::int32_t>(64, {3, 1, 2}).put<std::int32_t>(88, {1, 80}).text(208, "MAP \x44\x44");
    const Volume volume = load_volume(write("a", header.bytes + std::string(80, 'x') + counting(24)));
    EXPECT_EQ(volume.geometry.dims, glm::ivec3(2, 3, 4));
    EXPECT_EQ(volume.values[23], 23.0F);
    // Columns along z of 2, rows along x of 2, sections along y of 1 Angstrom; the first column is number 5.
    expect_axes(volume, glm::dmat3({0, 0, 2e-7}, {2e-7, 0, 0}, {0, 1e-7, 0}), {0, 0, 1e-6}, "cella and nxstart");
    EXPECT_FALSE(volume.in_patient);
    EXPECT_THAT(refusal(write("b.mrc", header.bytes + counting(24))), HasSubstr("truncated"));
    EXPECT_THAT(refusal(write("c.mrc", header.put<std::int32_t>(64, {1, 1, 2}).bytes + counting(200))),
                HasSubstr("mapc, mapr, maps"));
}

std::string npy(const std::string& dict, const std::string& data) {
    return std::string("\x93NUMPY\1\0", 8) + static_cast<char>(dict.size()) + '\0' + dict + data;
}

TEST_F(Headers, NumpyAxesAreZyx) {
    const std::string shape = "'shape': (2, 3, 4)}";
    const Volume rows =
        load_volume(write("a.npy", npy("{'descr': '|u1', 'fortran_order': False, " + shape, counting(24))));
    EXPECT_EQ(rows.geometry.dims, glm::ivec3(4, 3, 2));
    EXPECT_EQ(rows.at(3, 2, 1), 23.0F);
    EXPECT_EQ(rows.at(1, 0, 0), 1.0F);
    EXPECT_EQ(rows.geometry_source, "none: 1 mm assumed");
    const Volume columns =
        load_volume(write("b", npy("{'descr': '|u1', 'fortran_order': True, " + shape, counting(24))));
    EXPECT_EQ(columns.at(0, 0, 1), 1.0F);
    EXPECT_EQ(columns.at(1, 0, 0), 6.0F);
    const std::string four = npy("{'descr': '|u1', 'fortran_order': False, 'shape': (2, 3, 2, 2)}", counting(24));
    EXPECT_THAT(refusal(write("c.npy", four)), HasSubstr("--frame 0..1"));
    EXPECT_EQ(load_volume(file("c.npy"), {.frame = 1}).values[0], 12.0F);
    EXPECT_EQ(load_volume(file("c.npy"), {.component = 1}).values[1], 3.0F);
    for (const char* wrong : {"'|O'", "[('a', '<i2')]", "'<U3'", "'<f16'"})
        EXPECT_THAT(refusal(write("d.npy", npy(fmt::format("{{'descr': {}, 'fortran_order': False, {}", wrong, shape),
                                               counting(24)))),
                    HasSubstr("d.npy"));
}

}  // namespace
