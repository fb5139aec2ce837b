// A temporary folder per test, small volumes with known voxels and geometry, and ITK writers for them.
#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <itkImage.h>
#include <itkImageIOBase.h>
#include <unistd.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "engine/error.h"
#include "engine/volume/load_volume.h"

namespace volume_test {

namespace fs = std::filesystem;

class FolderTest : public testing::Test {
  protected:
    void SetUp() override {
        std::string name = (fs::temp_directory_path() / "edgesplat-test-XXXXXX").string();
        ASSERT_NE(mkdtemp(name.data()), nullptr);
        folder_ = name;
    }
    void TearDown() override {
        std::error_code ignored;
        fs::remove_all(folder_, ignored);
    }
    std::string file(const std::string& name) const { return (folder_ / name).string(); }
    std::string write(const std::string& name, const std::string& content) const {
        std::ofstream(file(name), std::ios::binary) << content;
        return file(name);
    }

    fs::path folder_;
};

inline std::string content_of(const std::string& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

/// The message of the Error that loading throws. If it loads: "" and a test failure.
inline std::string refusal(const std::string& path, const edgesplat::LoadOptions& options = {}) {
    try {
        (void)edgesplat::load_volume(path, options);
    } catch (const edgesplat::Error& error) {
        EXPECT_THAT(error.what(), testing::Not(testing::HasSubstr("\n[")));
        return error.what();
    }
    ADD_FAILURE() << path << " was read";
    return "";
}

/// Geometry of a test volume: oblique, anisotropic, left-handed.
struct Place {
    glm::dmat3 directions{{0.8, 0.6, 0}, {-0.48, 0.64, 0.6}, {-0.36, 0.48, -0.8}};  // columns; determinant -1
    glm::dvec3 spacing{0.5, 1.25, 3};
    glm::dvec3 origin{-10, 20.5, 7};
};

inline float voxel_value(int x, int y, int z) {
    return static_cast<float>(x + 10 * y + 100 * z - 150);
}
constexpr glm::ivec3 kDims{5, 4, 3};

/// Writes int16 voxels `voxel_value` through an ITK image IO.
inline void write_itk(itk::ImageIOBase* io, const std::string& path, const Place& place = {}, bool compress = false) {
    std::vector<short> voxels;
    for (int z = 0; z < kDims.z; ++z)
        for (int y = 0; y < kDims.y; ++y)
            for (int x = 0; x < kDims.x; ++x)
                voxels.push_back(static_cast<short>(voxel_value(x, y, z)));
    io->SetNumberOfDimensions(3);
    itk::ImageIORegion region(3);
    for (unsigned axis = 0; axis < 3; ++axis) {
        const int i = static_cast<int>(axis);
        io->SetDimensions(axis, static_cast<unsigned>(kDims[i]));
        io->SetSpacing(axis, place.spacing[i]);
        io->SetOrigin(axis, place.origin[i]);
        io->SetDirection(axis,
                         std::vector<double>{place.directions[i].x, place.directions[i].y, place.directions[i].z});
        region.SetSize(axis, static_cast<unsigned>(kDims[i]));
    }
    io->SetIORegion(region);
    io->SetNumberOfComponents(1);
    io->SetPixelType(itk::IOPixelEnum::SCALAR);
    io->SetComponentType(itk::IOComponentEnum::SHORT);
    io->SetUseCompression(compress);
    io->SetFileName(path);
    io->WriteImageInformation();
    io->Write(voxels.data());
}

inline void expect_voxels(const edgesplat::Volume& volume) {
    ASSERT_EQ(volume.geometry.dims, kDims);
    for (int z = 0; z < kDims.z; ++z)
        for (int y = 0; y < kDims.y; ++y)
            for (int x = 0; x < kDims.x; ++x)
                ASSERT_EQ(volume.at(x, y, z), voxel_value(x, y, z)) << x << ' ' << y << ' ' << z;
}

inline void expect_place(const edgesplat::Volume& volume, const Place& place, double tolerance = 1e-5) {
    for (int axis = 0; axis < 3; ++axis) {
        const auto wanted = place.directions[axis] * place.spacing[axis];
        EXPECT_LT(glm::length(volume.geometry.index_to_world_axes[axis] - wanted), tolerance) << "axis " << axis;
    }
    EXPECT_LT(glm::length(volume.geometry.origin - place.origin), tolerance * 10);
}

/// Path inside the folder that EDGESPLAT_DATA names; "" if it is not set.
inline std::string data(const std::string& name) {
    const char* folder = std::getenv("EDGESPLAT_DATA");
    return folder == nullptr || *folder == '\0' ? "" : std::string(folder) + "/" + name;
}

}  // namespace volume_test
