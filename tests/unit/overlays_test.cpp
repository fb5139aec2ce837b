// Overlays show correct values and change only pixels inside their boxes.
#include "engine/overlays/overlays.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>

#include "engine/scene/views.h"
#include "engine/volume/analytic_volumes.h"

namespace edgesplat {
namespace {

Volume patient_volume() {
    Volume volume;
    volume.geometry.dims = {40, 50, 30};
    volume.geometry.index_to_world_axes = {glm::dvec3(-1.6, 0, 0), glm::dvec3(0, 1.2, 0), glm::dvec3(0, 0, 2)};
    volume.geometry.origin = {30, -20, 5};
    volume.in_patient = true;
    return volume;
}

Scene two_materials() {
    Scene scene;
    scene.iso_values = {-400, 300};
    scene.materials = {{}, {{1, 0.7, 0.6}, 0.1, {}, "skin"}, {{1, 1, 0.9}, 5, {}, "bone"}};
    scene.effects.overlays = {true, true, true};
    return scene;
}

Image grey(int width, int height) {
    Image image(width, height, 4);
    std::fill(image.pixels.begin(), image.pixels.end(), 0.25F);
    return image;
}

TEST(Overlays, ScaleBarMatchesProjection) {
    const Volume volume = patient_volume();
    const glm::dvec3 center = volume.geometry.to_world((glm::dvec3(volume.geometry.dims) - 1.0) / 2.0);
    for (const double distance : {0.02, 3.0, 170.0, 20000.0}) {
        Scene scene = two_materials();
        scene.effects.overlays = {.scale_bar = true};
        const Camera camera{center + glm::dvec3(0.1, -1, 0.2) * distance, {0.1, 1, -0.1}, {0, 0.1, 1}, 35};
        Image image = grey(320, 240);
        draw_overlays(image, volume, scene, camera);
        const auto bar = scale_bar(volume, camera, 240, 0.25 * 320);
        ASSERT_TRUE(bar);
        // Two points at the centre's depth, bar->millimetres apart, projected by the camera.
        const CameraFrame frame = camera_frame(camera);
        const double depth = glm::dot(center - frame.eye, frame.forward);
        const auto column = [&](const glm::dvec3& p) {
            const glm::dvec3 q = p - frame.eye;
            return 160 + 120 * glm::dot(q, frame.right) / glm::dot(q, frame.forward) / frame.tan_half_y;
        };
        const double expected = column(frame.eye + depth * frame.forward + bar->millimetres * frame.right) -
                                column(frame.eye + depth * frame.forward);
        EXPECT_NEAR(bar->pixels, expected, 1e-9 * expected);
        EXPECT_LE(bar->pixels, 80);
        EXPECT_GT(bar->pixels, 80 * 0.39);
        const double mantissa = bar->millimetres / std::pow(10, std::floor(std::log10(bar->millimetres) + 1e-9));
        EXPECT_TRUE(std::abs(mantissa - 1) < 1e-9 || std::abs(mantissa - 2) < 1e-9 || std::abs(mantissa - 5) < 1e-9)
            << bar->millimetres;
        // In the picture: the longest run of ink in a row.
        int longest = 0;
        for (int y = 0; y < image.height; ++y)
            for (int x = 0, run = 0; x < image.width; ++x) {
                run = image.at(x, y, 0) > 0.6F ? run + 1 : 0;
                longest = std::max(longest, run);
            }
        EXPECT_NEAR(longest, bar->pixels, 1.0);
    }
    // There is no scale bar if the centre lies at or behind the eye.
    EXPECT_FALSE(scale_bar(volume, {center, {0, 1, 0}, {0, 0, 1}, 45}, 240, 80));
    EXPECT_FALSE(scale_bar(volume, {center + glm::dvec3(0, 9, 0), {0, 1, 0}, {0, 0, 1}, 45}, 240, 80));
}

TEST(Overlays, MarkerAxesMatchCamera) {
    Volume volume = patient_volume();
    const Camera front{{0, -300, 0}, {0, 1, 0}, {0, 0, 1}, 45};
    auto axes = marker_axes(volume, front);
    EXPECT_EQ(axes[0].positive + axes[1].positive + axes[2].positive, "LPH");
    EXPECT_EQ(axes[0].negative + axes[1].negative + axes[2].negative, "RAF");
    EXPECT_LT(glm::length(axes[0].along - glm::dvec2(1, 0)), 1e-12)
        << "seen from the front, the patient's left is on the right";
    EXPECT_NEAR(axes[1].towards_eye, -1, 1e-12) << "posterior points away from the eye";
    EXPECT_LT(glm::length(axes[2].along - glm::dvec2(0, -1)), 1e-12);
    volume.in_patient = false;
    axes = marker_axes(volume, front);
    EXPECT_EQ(axes[0].positive + axes[1].positive + axes[2].positive, "XYZ");
    EXPECT_LT(glm::length(axes[0].along - glm::dvec2(-1, 0)), 1e-12) << "the index axis i points to the left";
    // From far away, a perspective picture shows the axes in the same directions.
    const Camera oblique{{3000, -9000, 5000}, {-0.3, 0.9, -0.5}, {0.2, 0, 1}, 20};
    const CameraFrame frame = camera_frame(oblique);
    axes = marker_axes(volume, oblique);
    for (int i = 0; i < 3; ++i) {
        const auto seen = [&](const glm::dvec3& p) {
            const glm::dvec3 q = p - frame.eye;
            return glm::dvec2(glm::dot(q, frame.right), -glm::dot(q, frame.up)) / glm::dot(q, frame.forward);
        };
        const glm::dvec3 tip = frame.eye + 1e4 * frame.forward;
        const glm::dvec2 way = seen(tip + volume_axes(volume.geometry)[i]) - seen(tip);
        EXPECT_LT(glm::length(glm::normalize(way) - glm::normalize(axes[static_cast<std::size_t>(i)].along)), 1e-3);
    }
}

TEST(Overlays, DrawOnlyInsideTheirBoxes) {
    const Volume volume = patient_volume();
    Scene transfer = two_materials();
    transfer.transfer = {{-1000, {0, 0, 0}, 0}, {-300, {1, 0.6, 0.5}, 0.1}, {400, {1, 1, 0.9}, 0.4}};
    for (const glm::ivec2 size : {glm::ivec2(64, 64), {400, 300}, {4000, 100}, {30, 900}, {1, 1}, {1200, 4000}}) {
        for (const Scene& scene : {two_materials(), transfer}) {
            Image image = grey(size.x, size.y);
            const Camera camera = named_view("oblique", {&volume, &scene, 40, size.x, size.y});
            const std::vector<PixelBox> boxes = draw_overlays(image, volume, scene, camera);
            EXPECT_EQ(boxes.size(), 3U);
            std::vector<int> changed(boxes.size(), 0);
            for (int y = 0; y < size.y; ++y)
                for (int x = 0; x < size.x; ++x) {
                    bool other = false;
                    for (int c = 0; c < 4; ++c) {
                        other |= image.at(x, y, c) != 0.25F;
                        ASSERT_TRUE(image.at(x, y, c) >= 0 && image.at(x, y, c) <= 1);
                    }
                    if (!other) continue;
                    bool inside = false;
                    for (std::size_t b = 0; b < boxes.size(); ++b)
                        if (boxes[b].contains(x, y)) {
                            inside = true;
                            ++changed[b];
                        }
                    ASSERT_TRUE(inside) << x << ", " << y;
                }
            if (size.x < 400) continue;
            for (const int count : changed)
                EXPECT_GT(count, 100);
        }
    }
    Scene none = two_materials();
    none.effects.overlays = {};
    Image image = grey(50, 40);
    EXPECT_TRUE(draw_overlays(image, volume, none, {{0, -300, 0}, {0, 1, 0}, {0, 0, 1}, 45}).empty());
    EXPECT_EQ(image.pixels, grey(50, 40).pixels);
}

}  // namespace
}  // namespace edgesplat
