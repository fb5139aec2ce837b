// Difficult pictures: sizes, splats smaller than a pixel or larger than the picture, sheets that begin on a layer of
// voxels, matter in the plane of the eye.
#include <algorithm>
#include <cmath>

#include "engine/reference/3_select_footprints.h"
#include "footprints/kernel.h"
#include "tests/stability/hazard.h"

namespace edgesplat::test {
namespace {

Shot torus_seen() {
    static const auto volume =
        std::make_shared<const Volume>(sample(torus_scene({24, 24, 14}, {11.6, 11.3, 6.4}, 6.7, 3.2)));
    Shot shot = shot_of(volume);
    shot.scene.lights = {Light{}};
    shot.camera = look(*volume, {14, -30, 31}, {11.6, 5.1, 6.8}, 30);
    return shot;
}

/// A shot of `size` pixels with the same rays as the middle of a picture `of` pixels high.
Shot middle_part(Shot shot, int of, const glm::ivec2& size) {
    const double tangent = std::tan(glm::radians(shot.camera.fov_y) / 2) * size.y / of;
    shot.camera.fov_y = 2 * glm::degrees(std::atan(tangent));
    shot.width = size.x;
    shot.height = size.y;
    return shot;
}

/// Cuts out the middle of a picture.
Image cut_out(const Image& image, const glm::ivec2& size) {
    Image part(size.x, size.y, image.channels);
    const int left = (image.width - size.x) / 2, top = (image.height - size.y) / 2;
    for (int y = 0; y < size.y; ++y)
        for (int x = 0; x < size.x; ++x)
            for (int c = 0; c < image.channels; ++c)
                part.at(x, y, c) = image.at(left + x, top + y, c);
    return part;
}

/// A picture of this size equals the middle of a picture of 97 x 97 (or 96 x 96) with the same rays.
void expect_middle_of_a_larger(const glm::ivec2& size) {
    Shot whole = torus_seen();
    whole.width = 96 + size.x % 2;
    whole.height = 96 + size.y % 2;
    const Image want = cut_out(render(whole).color, size);
    const Shot part = middle_part(whole, whole.height, size);
    const Image got = sound(part, "a part").color;
    EXPECT_GT(middle_of(got, 3).most, 0.2) << "the picture is empty";
    // Pixels only differ by the rounding of their rays.
    EXPECT_LE(compare_images(want, got).max, 2e-4) << size.x << " x " << size.y;
}

TEST(ViewPicture, OfOnePixel) {
    expect_middle_of_a_larger({1, 1});
}
TEST(ViewPicture, OfOneRow) {
    expect_middle_of_a_larger({89, 1});
}
TEST(ViewPicture, OfOneColumn) {
    expect_middle_of_a_larger({1, 89});
}
TEST(ViewPicture, OfOddSizes) {
    expect_middle_of_a_larger({37, 23});
    expect_middle_of_a_larger({17, 31});
    expect_middle_of_a_larger({33, 65});
}
TEST(ViewPicture, OfSizesNearMultiplesOfATile) {
    for (const int edge : {15, 16, 17, 31, 32, 33})
        expect_middle_of_a_larger({edge, edge + 1});
}

TEST(ViewPicture, Of16384PixelsInARow) {
    Shot wide = torus_seen();
    wide.width = 16384;
    wide.height = 2;
    wide.camera.fov_y = 0.02;
    const Image all = render(wide).color;
    EXPECT_TRUE(within(all, 0, 1.0001F));
    const Image want = render(middle_part(wide, 2, {64, 2})).color;
    EXPECT_LE(compare_images(cut_out(all, {64, 2}), want).max, 2e-3);
}

TEST(ViewPicture, Of8192By8192Pixels) {
    Shot large = torus_seen();
    large.camera.fov_y = 120;  // the torus in the middle, the rest empty
    large.width = large.height = 8192;
    Image all;
    try {
        all = render(large).color;
    } catch (const Error& error) {
        // A driver with 2 GiB in total has room for fewer rows; it reports this before it allocates.
        EXPECT_NE(std::string(error.what()).find("MiB are available"), std::string::npos) << error.what();
        large.height = 8000;
        all = render(large).color;
    }
    ASSERT_EQ(all.pixels.size(), static_cast<std::size_t>(4 * large.width * large.height));
    EXPECT_TRUE(within(all, 0, 1.0001F));
    const glm::ivec2 part(96, 96);
    const Image want = render(middle_part(large, large.height, part)).color;
    EXPECT_GT(middle_of(want, 3).most, 0.2);
    EXPECT_LE(compare_images(cut_out(all, part), want).max, 2e-3) << "rays of 8192 pixels, in single precision";
}

/// A near wall with a hole, and specks of one voxel far behind.
Shot specks_shot() {
    Volume volume;
    volume.geometry.dims = {64, 64, 320};
    for (int z = 0; z < 320; ++z)
        for (int y = 0; y < 64; ++y)
            for (int x = 0; x < 64; ++x) {
                const bool wall = z < 4 && std::hypot(x - 31.5, y - 31.5) > 2.2;
                const bool speck = z == 316 && x % 13 == 5 && y % 15 == 7;
                volume.values.push_back(wall || speck ? 1.0F : 0.0F);
            }
    finish_volume(volume);
    Shot shot = shot_of(std::make_shared<const Volume>(std::move(volume)));
    shot.scene.iso_values = {0.5};
    shot.scene.materials = {{}, {{1, 0.9, 0.8}, 3}};
    shot.scene.lights = {Light{}};
    shot.camera = look(*shot.volume, {31.5, 31.5, -7}, {31.5, 31.5, 100}, 50, {0, 1, 0});
    shot.width = shot.height = 300;
    return shot;
}

TEST(ViewPicture, SpecksSmallerThanAStepOfRefinedPixels) {
    if (!refines_pixels()) GTEST_SKIP() << "this device draws every pixel";
    Shot shot = specks_shot();
    const RenderResult refined = render(shot);
    EXPECT_TRUE(
        std::ranges::any_of(refined.stats.passes, [](const PassTime& p) { return p.name == "5_refine_pixels"; }));
    shot.settings.pixels = PixelChoice::Every;
    const Image every = render(shot).color;
    EXPECT_NE(refined.color.pixels, every.pixels) << "some pixels must be interpolated";
    // The middle of the picture shows the specks.
    EXPECT_GT(middle_of(every, 3).most, 0.5);
    EXPECT_LE(compare_images(refined.color, every).max, 6e-3);
}

TEST(ViewPicture, SplatsOfAThousandthOfAPixel) {
    // The whole volume covers a fiftieth of a pixel. With footprints as wide as a pixel, opacity is proportional to the
    // covered share.
    Shot shot = torus_seen();
    const double voxels_a_pixel = 1000, distance = 1e5;
    shot.width = shot.height = 9;
    const glm::dvec3 middle(11.6, 11.3, 6.4), way = glm::normalize(glm::dvec3(0.2, 1, -0.8));
    shot.camera = look(*shot.volume, middle - distance * way, middle,
                       2 * glm::degrees(std::atan(4.5 * voxels_a_pixel / distance)));
    sound(shot, "without antialiasing");
    shot.scene.effects.antialias = true;
    shot.scene.materials[1].extinction = 0.01;
    const Image tau = *sound(shot, "with antialiasing").tau;
    double sum = 0;
    for (const float t : tau.pixels)
        sum += static_cast<double>(t);
    std::size_t full = 0;
    for (const float v : shot.volume->values)
        full += v >= 0.5F ? 1U : 0U;
    const double expected = 0.01 * static_cast<double>(full) / (voxels_a_pixel * voxels_a_pixel);
    EXPECT_NEAR(sum / expected, 1, 0.05) << "matter was lost or invented";
}

TEST(ViewPicture, SplatsOfTenThousandPixels) {
    // One voxel, so near that its kernel is 16000 pixels wide; the ray through each pixel is known.
    const auto one = volume_of({1, 1, 1}, [](const glm::ivec3&) { return 1.0F; });
    Shot shot = shot_of(one, 0.5, 0.7);
    const double distance = 2, pixel = 1e-4;  // voxels between rays at the voxel
    shot.width = shot.height = 33;
    shot.camera = look(*one, {-distance, 0.8, 0}, {0, 0.8, 0}, 2 * glm::degrees(std::atan(16.5 * pixel / distance)));
    const Image tau = *sound(shot, "one voxel").tau;
    for (int x = 0; x < 33; ++x) {
        // Here, +x of the picture is -y of the world: the eye looks along +x, up is about z.
        const glm::dvec3 eye(-distance, 0.8, 0);
        const glm::dvec3 u = reference::View(shot.camera, one->geometry, 33, 33).ray(x, 16);
        const double rho2 = glm::dot(eye, eye) - std::pow(glm::dot(eye, u), 2);
        EXPECT_NEAR(static_cast<double>(tau.at(x, 16, 0)), 0.7 * kernel_footprint(rho2), 3e-6) << x;
    }
}

TEST(ViewPicture, CloserThanAVoxelToASurface) {
    Shot shot = torus_seen();
    shot.camera = look(*shot.volume, {11.6, 11.3 - 6.7 - 3.2 - 0.05, 6.4}, {11.6, 11.3, 6.4}, 40);
    shot.scene.materials[1].extinction = 20;
    EXPECT_GE(against_reference(shot, "0.05 voxels from a surface").psnr, 55);
}

TEST(ViewPicture, VoxelsInThePlaneOfTheEye) {
    // Looks along y from y = 11 exactly: 24 x 14 voxel centres have depth 0.
    for (const double fov : {60.0, 150.0}) {
        Shot shot = torus_seen();
        shot.camera = look(*shot.volume, {11.6, 11, 6.4}, {11.6, 20, 6.4}, fov);
        shot.scene.materials[1].extinction = 0.4;
        EXPECT_GE(against_reference(shot, "voxels at depth 0").psnr, 58) << fov;
        Shot beside = shot;
        beside.camera.eye.y += 1e-7;
        EXPECT_GE(compare_images(render(shot).color, render(beside).color).psnr, 45) << "a step of 1e-7 voxels";
    }
}

TEST(ViewPicture, SheetsThatBeginOnALayerOfVoxels) {
    // Looks along x from a whole number of sheets before the first layer: every layer lies on a boundary, and rounding
    // decides its side. The picture must not depend on it.
    const auto block = volume_of({16, 9, 9}, [](const glm::ivec3& v) { return v.x % 3 == 0 ? 0.4F : 1.0F; });
    for (const SheetCut sheets : {SheetCut::Whole, SheetCut::Sliced}) {
        for (const double spacing : {0.25, 0.5, 1.0, 2.0}) {
            Image first;
            for (const double off : {0.0, 1e-9, -1e-9, 1e-5, -1e-5}) {
                Shot shot = shot_of(block, 0.5, 0.15);
                shot.settings.sheets = sheets;
                shot.settings.sheet_spacing = spacing;
                shot.settings.saturation = 1;
                shot.camera = look(*block, {-64 + off, 4, 4}, {8, 4, 4}, 3);
                shot.width = shot.height = 8;
                const Image color = render(shot).color;
                if (first.pixels.empty()) first = color;
                EXPECT_LE(compare_images(first, color).max, 2e-4) << spacing << ", moved by " << off;
            }
        }
    }
}

}  // namespace
}  // namespace edgesplat::test
