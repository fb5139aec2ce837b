// Slices: their voxels, their orientation and the inverse mapping.
#include "engine/viewer/slices.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <string>

#include "engine/volume/pack_volume.h"
#include "engine/volume/packed_volume.h"
#include "tests/unit/refusal.h"
#include "tests/unit/viewer_volumes.h"

namespace edgesplat::viewer {
namespace {

/// Value x + 10 y + 100 z, 6 x 5 x 4 voxels of 1 x 2 x 3 mm.
Volume ramp(const glm::dmat3& directions = glm::dmat3(1)) {
    Volume volume;
    volume.geometry.dims = {6, 5, 4};
    const glm::dvec3 spacing(1, 2, 3);
    for (int axis = 0; axis < 3; ++axis)
        volume.geometry.index_to_world_axes[axis] = directions[axis] * spacing[axis];
    for (int z = 0; z < 4; ++z)
        for (int y = 0; y < 5; ++y)
            for (int x = 0; x < 6; ++x)
                volume.values.push_back(static_cast<float>(x + 10 * y + 100 * z));
    finish_volume(volume);
    return volume;
}

int grey_at(const Slice& s, int column, int row) {
    return s.grey[static_cast<std::size_t>(row * s.width + column)];
}

TEST(ViewerSlices, ShowTheVoxelsOfTheirPlane) {
    const Volume volume = ramp();
    // A window of 0 to 255 shows values as they are.
    const Slice axial = slice(volume, 2, {2, 3, 1.3}, 0, 255);
    EXPECT_EQ(axial.width, 6);
    EXPECT_EQ(axial.height, 5);
    EXPECT_EQ(axial.pixel_mm, glm::dvec2(1, 2));
    EXPECT_EQ(axial.cross, glm::dvec2(2.5, 3.5));
    for (int row = 0; row < 5; ++row)
        for (int column = 0; column < 6; ++column)
            EXPECT_EQ(grey_at(axial, column, row), column + 10 * row + 100);
    // Upright: +z is up.
    const Slice coronal = slice(volume, 1, {2, 3, 1}, 0, 255);
    EXPECT_EQ(coronal.width, 6);
    EXPECT_EQ(coronal.height, 4);
    EXPECT_EQ(coronal.pixel_mm, glm::dvec2(1, 3));
    EXPECT_EQ(grey_at(coronal, 2, 3), 32);
    EXPECT_EQ(grey_at(coronal, 2, 2), 132);
    EXPECT_EQ(coronal.cross, glm::dvec2(2.5, 2.5));
    const Slice sagittal = slice(volume, 0, {2, 3, 1}, 0, 255);
    EXPECT_EQ(sagittal.width, 5);
    EXPECT_EQ(grey_at(sagittal, 4, 3), 42);
}

TEST(ViewerSlices, MapWindowToGrey) {
    const Volume volume = ramp();
    const Slice s = slice(volume, 2, {0, 0, 0}, 10, 30);
    EXPECT_EQ(grey_at(s, 0, 0), 0);
    EXPECT_EQ(grey_at(s, 0, 1), 0);
    EXPECT_EQ(grey_at(s, 0, 2), 128);
    EXPECT_EQ(grey_at(s, 0, 4), 255);
}

TEST(ViewerSlices, HandleEveryAxisDirection) {
    // The value at the cross and the picture's directions must not depend on the file's order of axes.
    for (int signs = 0; signs < 8; ++signs)
        for (const auto& order : {glm::ivec3(0, 1, 2), glm::ivec3(1, 2, 0), glm::ivec3(2, 0, 1), glm::ivec3(1, 0, 2)}) {
            glm::dmat3 directions(0);
            for (int axis = 0; axis < 3; ++axis)
                directions[axis][order[axis]] = (signs >> axis & 1) != 0 ? -1 : 1;
            const Volume volume = ramp(directions);
            for (int axis = 0; axis < 3; ++axis) {
                const glm::dvec3 voxel(4, 1, 2);
                const Slice s = slice(volume, axis, voxel, 0, 500);
                EXPECT_EQ(s.axis, axis);
                const int expected = static_cast<int>(std::lround((4 + 10 + 200) * 255.0 / 500));
                EXPECT_EQ(grey_at(s, static_cast<int>(s.cross.x), static_cast<int>(s.cross.y)), expected);
                // One pixel right and one down, in the world.
                const glm::dvec3 here = volume.geometry.to_world(voxel_at(s, s.cross));
                const glm::dvec3 right = volume.geometry.to_world(voxel_at(s, s.cross + glm::dvec2(1, 0))) - here;
                const glm::dvec3 down = volume.geometry.to_world(voxel_at(s, s.cross + glm::dvec2(0, 1))) - here;
                EXPECT_GT(right.x + right.y, 0);
                EXPECT_EQ(right.z, 0);
                EXPECT_GT(down.x + down.y - down.z, 0);
                EXPECT_NEAR(glm::length(right), s.pixel_mm.x, 1e-12);
                EXPECT_NEAR(glm::length(down), s.pixel_mm.y, 1e-12);
                EXPECT_LT(glm::length(voxel_at(s, s.cross) - voxel), 1e-12);
                EXPECT_LT(glm::length(pixel_at(s, voxel_at(s, {1.25, 3.75})) - glm::dvec2(1.25, 3.75)), 1e-12);
            }
        }
}

TEST(ViewerSlices, ClampOutsidePlacesInDepthOnly) {
    const Slice s = slice(ramp(), 2, {-4, 9, 77}, 0, 500);
    EXPECT_EQ(s.depth, 3);
    EXPECT_EQ(s.cross, glm::dvec2(-3.5, 9.5));
}

TEST(ViewerSlices, ShowLargePackedVolumesCoarsely) {
    Volume volume;
    volume.geometry.dims = {1500, 8, 6};
    for (int i = 0; i < 1500 * 8 * 6; ++i)
        volume.values.push_back(static_cast<float>(i % 1500));
    finish_volume(volume);
    const auto file =
        std::filesystem::temp_directory_path() / ("edgesplat-viewer-slices-" + std::to_string(getpid()) + ".h5");
    pack_volume(volume, file.string());
    const Volume packed = open_packed(file.string());
    const Slice fine = slice(packed, 0, {700, 3, 2}, 0, 1500), same = slice(volume, 0, {700, 3, 2}, 0, 1500);
    EXPECT_EQ(fine.grey, same.grey);
    EXPECT_EQ(fine.cross, same.cross);
    const Slice coarse = slice(packed, 2, {700, 3, 5}, 0, 1500);
    std::filesystem::remove(file);
    EXPECT_EQ(coarse.width, 750);
    EXPECT_EQ(coarse.height, 4);
    EXPECT_EQ(coarse.voxels, 2);
    EXPECT_EQ(coarse.pixel_mm, glm::dvec2(2));
    EXPECT_EQ(coarse.cross, glm::dvec2(350.25, 1.75));
    EXPECT_EQ(grey_at(coarse, 350, 1), std::lround(700.5 * 255 / 1500));
    EXPECT_LT(glm::length(voxel_at(coarse, coarse.cross) - glm::dvec3(700, 3, 5)), 1e-9);
}

TEST(ViewerSlices, LabelSidesWithPatientLetters) {
    const auto letters = [](const Volume& volume, int axis) {
        const auto four = slice_letters(slice(volume, axis, {3, 2, 2}, 0, 300), volume.geometry);
        return std::string(four.begin(), four.end());
    };
    // Views are from the feet and from the front: the patient's right is on the left. Order: left, right, top, bottom.
    const Volume upright = ramp();
    EXPECT_EQ(letters(upright, 2), "RLAP");
    EXPECT_EQ(letters(upright, 1), "RLHF");
    EXPECT_EQ(letters(upright, 0), "APHF");
    // Permuted and slightly rotated axes give the same letters.
    const Volume lying = ramp(glm::dmat3(glm::dvec3(0, 0.1, -1), glm::dvec3(-1, 0.1, 0), glm::dvec3(0.1, 1, 0.1)));
    EXPECT_EQ(letters(lying, 0), "RLAP");
    EXPECT_EQ(letters(lying, 2), "RLHF");
    EXPECT_EQ(letters(lying, 1), "APHF");
}

TEST(ViewerSlices, RefuseInvalidArguments) {
    const Volume volume = ramp();
    EXPECT_NE(refusal([&] { slice(volume, 3, glm::dvec3(0), 0, 1); }).find("axis"), std::string::npos);
    EXPECT_NE(refusal([&] { slice(volume, 0, glm::dvec3(0), 1, 1); }).find("window"), std::string::npos);
    EXPECT_NE(refusal([&] { slice(volume, 0, glm::dvec3(0, NAN, 0), 0, 1); }).find("finite"), std::string::npos);
}

}  // namespace
}  // namespace edgesplat::viewer
