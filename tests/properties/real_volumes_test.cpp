// Real volumes from the folder that EDGESPLAT_DATA names; skipped without it.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>

#include "engine/volume/load_volume.h"
#include "tests/properties/scenes.h"

namespace edgesplat::test {
namespace {

/// Mean squared difference of neighbouring pixels' luminance; blur reduces it.
double sharpness(const Image& image) {
    const auto luminance = [&](int x, int y) {
        return static_cast<double>(image.at(x, y, 0) + image.at(x, y, 1) + image.at(x, y, 2)) / 3;
    };
    double sum = 0;
    for (int y = 0; y + 1 < image.height; ++y) {
        for (int x = 0; x + 1 < image.width; ++x) {
            const double dx = luminance(x + 1, y) - luminance(x, y), dy = luminance(x, y + 1) - luminance(x, y);
            sum += dx * dx + dy * dy;
        }
    }
    return sum / (image.width * image.height);
}

class RealVolumes : public testing::Test {
  protected:
    void SetUp() override {
        const char* folder = std::getenv("EDGESPLAT_DATA");
        if (folder == nullptr || *folder == '\0')
            GTEST_SKIP() << "EDGESPLAT_DATA is not set: no folder of real volumes";
        folder_ = std::string(folder) + "/";
    }

    Shot shot_of(const std::string& name) const {
        Shot shot;
        shot.volume = std::make_shared<const Volume>(load_volume(folder_ + name));
        shot.width = shot.height = 128;
        return shot;
    }

    /// Looks from a voxel along a direction in index space.
    static void stand(Shot& shot, const glm::dvec3& voxel, const glm::dvec3& direction, const glm::dvec3& up) {
        shot.camera.eye = shot.volume->geometry.to_world(voxel);
        shot.camera.direction = shot.volume->geometry.index_to_world_axes * direction;
        shot.camera.up = up;
        shot.camera.fov_y = 90;
    }

    /// Sharpness with edges relative to plain splatting; checks that both are finite.
    static double gain_in_sharpness(Shot shot) {
        const Image edges = render(shot).color;
        EXPECT_TRUE(within(edges, 0, 1.0001F));
        shot.settings.edges = EdgeEstimator::Off;
        const Image plain = render(shot).color;
        EXPECT_TRUE(within(plain, 0, 1.0001F));
        const double gain = sharpness(edges) / sharpness(plain);
        std::printf("sharpness %.5f, plain %.5f: x %.2f\n", sharpness(edges), sharpness(plain), gain);
        return gain;
    }

  private:
    std::string folder_;
};

TEST_F(RealVolumes, NasalPassagesAreSharperThanPlain) {
    Shot shot = shot_of("cranium_ct/cranium.nhdr");
    shot.scene.iso_values = {-400};
    shot.scene.materials = {{}, {{1, 0.85, 0.75}, 4}};
    stand(shot, {128, 148, 14}, {0, 1, 0.05}, {0, 0, 1});
    EXPECT_GE(gain_in_sharpness(shot), 1.5);
}

TEST_F(RealVolumes, AirwayIsSharperThanPlain) {
    Shot shot = shot_of("chest_ct_dicom");
    shot.scene.iso_values = {-600};
    shot.scene.materials = {{}, {{1, 0.7, 0.65}, 4}};
    stand(shot, {231, 292, 31}, {0.1, 0.05, -1}, {0, -1, 0});
    const Image color = render(shot).color;
    EXPECT_TRUE(within(color, 0, 1.0001F));
    EXPECT_GE(gain_in_sharpness(shot), 1.1);
}

TEST_F(RealVolumes, BothSurfacesOfTheIronProteinAreVisible) {
    Shot shot = shot_of("hipip/hipip.nhdr");
    shot.scene.iso_values = {20, 128};
    shot.scene.materials = {{}, {{0, 0, 1}, 0.08}, {{1, 0, 0}, 3}};
    const glm::dvec3 middle = glm::dvec3(shot.volume->geometry.dims - 1) / 2.0;
    shot.camera = look(*shot.volume, middle - glm::dvec3(0, 110, 0), middle, 40);
    const Image color = render(shot).color;
    EXPECT_TRUE(within(color, 0, 1.0001F));
    int blue = 0, red = 0;
    for (int y = 0; y < color.height; ++y) {
        for (int x = 0; x < color.width; ++x) {
            blue += color.at(x, y, 2) > 0.05F ? 1 : 0;
            red += color.at(x, y, 0) > 0.1F ? 1 : 0;
        }
    }
    EXPECT_GT(blue, 1000) << "pixels of the outer shell";
    EXPECT_GT(red, 100) << "pixels of the inner parts, through the shell";
}

}  // namespace
}  // namespace edgesplat::test
