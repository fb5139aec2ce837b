// Volumes of one slice, and matter of single voxels: a slice is one voxel thick, and what is thin fills the picture,
// too.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <utility>

#include "engine/reference/3_select_footprints.h"
#include "engine/scene/views.h"
#include "tests/properties/scenes.h"

namespace edgesplat::test {
namespace {

constexpr double kDiscRadius = 9.3;                // voxels
const glm::dvec3 kSliceSpacing(2.08, 2.08, 2.03);  // mm

/// A disc in each of `slices` slices.
VolumePointer disc(int slices) {
    return sampled(
        {32, 32, slices},
        [](const glm::dvec3& x) {
            return std::clamp(0.5 + kDiscRadius - std::hypot(x.x - 15.4, x.y - 15.7), 0.0, 1.0);
        },
        glm::dmat3(kSliceSpacing.x, 0, 0, 0, kSliceSpacing.y, 0, 0, 0, kSliceSpacing.z));
}

Shot disc_from_above(int slices, double extinction) {
    Shot shot;
    shot.volume = disc(slices);
    shot.scene.iso_values = {0.5};
    shot.scene.materials = {{}, {{1, 0.8, 0.6}, extinction}};
    shot.width = shot.height = 96;
    shot.camera = named_view("top", {.volume = shot.volume.get(),
                                     .scene = &shot.scene,
                                     .fov_y = 20,
                                     .width = shot.width,
                                     .height = shot.height,
                                     .fill = true});
    return shot;
}

TEST(Thin, SlicesAreFlatDiscsThatFillThePicture) {
    for (const int slices : {1, 2}) {
        SCOPED_TRACE(slices);
        Shot shot = disc_from_above(slices, 8);
        const Image bare = [&] {
            Shot unlit = shot;
            unlit.scene.lights.clear();
            return render(unlit).color;
        }();
        shot.scene.lights = {directional_light({0, 0, 1})};
        shot.scene.lights[0].intensity = 1;
        shot.scene.ambient = 0;
        const Image lit = render(shot).color;
        const CameraFrame frame = camera_frame(shot.camera);
        int covered = 0, widest = 0;
        float off = 0, opacity = 1;
        for (int y = 0; y < shot.height; ++y) {
            int across = 0;
            for (int x = 0; x < shot.width; ++x) {
                across += lit.at(x, y, 3) > 0.5F ? 1 : 0;
                const double from_middle = std::hypot(x + 0.5 - shot.width / 2.0, y + 0.5 - shot.height / 2.0);
                if (from_middle > 0.42 * shot.width) continue;
                // Light along the face's normal shows the matter's own colour.
                for (int c = 0; c < 4; ++c)
                    off = std::max(off, std::abs(lit.at(x, y, c) - bare.at(x, y, c)));
                opacity = std::min(opacity, lit.at(x, y, 3));
            }
            covered += across;
            widest = std::max(widest, across);
        }
        EXPECT_LE(off, 0.01F);
        EXPECT_GT(opacity, 0.99F);
        EXPECT_GE(widest, 0.9 * shot.width);
        const double top = shot.volume->geometry.to_world({0, 0, slices - 0.5}).z;
        const double pixel = 2 * frame.tan_half_y * std::abs(frame.eye.z - top) / shot.height;
        const double radius = kDiscRadius * kSliceSpacing.x;
        EXPECT_NEAR(covered * pixel * pixel, std::numbers::pi * radius * radius, 0.02 * covered * pixel * pixel);
    }
}

TEST(Thin, SlicesAreAVoxelThick) {
    for (const int slices : {1, 2, 3}) {
        const Shot shot = disc_from_above(slices, 0.1);
        const Image tau = render_tau(shot);
        const double want = 0.1 * slices * kSliceSpacing.z;
        for (int y = 24; y < 72; y += 3)
            for (int x = 24; x < 72; x += 3)
                EXPECT_NEAR(tau.at(x, y, 0), want, 0.05 * want) << slices << ": " << x << ", " << y;
    }
}

/// From the side a slice is a bar of its thickness.
TEST(Thin, ASliceFromTheSideIsABar) {
    Shot shot = disc_from_above(1, 8);
    shot.camera = named_view("front", {.volume = shot.volume.get(),
                                       .scene = &shot.scene,
                                       .fov_y = 10,
                                       .width = shot.width,
                                       .height = shot.height,
                                       .fill = true});
    const Image color = render(shot).color;
    const CameraFrame frame = camera_frame(shot.camera);
    const double distance = std::abs(frame.eye.y - shot.volume->geometry.center().y);
    const double pixel = 2 * frame.tan_half_y * distance / shot.height;
    double high = 0;
    for (int y = 0; y < shot.height; ++y)
        high += static_cast<double>(color.at(shot.width / 2, y, 3));
    EXPECT_NEAR(high * pixel, kSliceSpacing.z, 0.1 * kSliceSpacing.z + pixel);
}

// A block that the volume's low end along x cuts. Only rays that enter there may begin in matter.
TEST(Thin, TheBorderIsSearchedOnlyWhereRaysMayEnterMatter) {
    Volume volume;
    volume.geometry.dims = glm::ivec3(24);
    for (int z = 0; z < 24; ++z)
        for (int y = 0; y < 24; ++y)
            for (int x = 0; x < 24; ++x) {
                const double inside = std::min(9.3 - x, 7.4 - std::max(std::abs(y - 11.5), std::abs(z - 11.5)));
                volume.values.push_back(static_cast<float>(std::clamp(0.5 + inside, 0.0, 1.0)));
            }
    finish_volume(volume);
    Shot shot;
    shot.volume = std::make_shared<const Volume>(std::move(volume));
    shot.scene.iso_values = {0.5};
    shot.scene.materials = {{}, {{1, 1, 1}, 8}};
    for (const double side : {-1.0, 1.0}) {
        shot.camera = look(*shot.volume, {11.5 + side * 60, 11.5, 11.5}, glm::dvec3(11.5), 40);
        const RenderResult result = render(shot);
        const bool searched = std::ranges::any_of(result.stats.passes,
                                                  [](const PassTime& pass) { return pass.name == "5_begin_surfaces"; });
        EXPECT_EQ(searched, side < 0);
        EXPECT_EQ(result.color.at(32, 32, 3), 1.0F) << side;
        EXPECT_EQ(result.color.at(3, 32, 3), 0.0F) << side;
    }
}

/// Eight corners of value 1 and a middle of value 3, between zeros.
VolumePointer corners_and_middle() {
    return sampled({3, 3, 3}, [](const glm::dvec3& x) {
        const glm::dvec3 d = glm::abs(x - 1.0);
        return d == glm::dvec3(0) ? 3.0 : d == glm::dvec3(1) ? 1.0 : 0.0;
    });
}

TEST(Thin, CornersOfASmallGridStayApart) {
    Shot shot;
    shot.volume = corners_and_middle();
    shot.scene.iso_values = {0.7};
    shot.scene.materials = {{}, {{1, 1, 1}, 20}};
    shot.width = shot.height = 96;
    for (const char* view : {"front", "left", "top"}) {
        SCOPED_TRACE(view);
        shot.camera = named_view(view, {.volume = shot.volume.get(),
                                        .scene = &shot.scene,
                                        .fov_y = 5,
                                        .width = shot.width,
                                        .height = shot.height,
                                        .fill = true});
        const Image color = render(shot).color;
        // The middle of each side, and the corners of the picture.
        const int low = 4, middle = 48, high = 91;
        for (const auto& [x, y] : {std::pair(low, middle), {high, middle}, {middle, low}, {middle, high}})
            EXPECT_EQ(color.at(x, y, 3), 0) << x << ", " << y;
        for (const auto& [x, y] : {std::pair(low, low), {high, low}, {low, high}, {high, high}, {middle, middle}})
            EXPECT_GT(color.at(x, y, 3), 0.9F) << x << ", " << y;
    }
}

}  // namespace
}  // namespace edgesplat::test
