// Labels in their own colours: on the device, by rays and by the reference.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "engine/reference/reference_renderer.h"
#include "engine/scene/label_fade.h"
#include "engine/volume/labels.h"
#include "engine/volume/segmentation.h"
#include "tests/properties/scenes.h"

namespace edgesplat::test {
namespace {

const glm::dvec3 kRed(1, 0, 0), kBlue(0, 0, 1);

/// A ball in two halves, labels 1 and 2, with a shell of label 3 around it that only its upper part has.
double label_of(const glm::dvec3& p) {
    const double r = glm::length(p - glm::dvec3(11.6, 11.3, 11.4));
    if (r < 7) return p.x < 11.6 ? 1 : 2;
    return r < 9 && p.z > 15 ? 3 : 0;
}

VolumePointer label_volume(const std::vector<bool>& shown) {
    Volume volume;
    volume.geometry.dims = glm::ivec3(24);
    for (int z = 0; z < 24; ++z)
        for (int y = 0; y < 24; ++y)
            for (int x = 0; x < 24; ++x)
                volume.values.push_back(static_cast<float>(label_of({x, y, z})));
    finish_volume(volume);
    return std::make_shared<const Volume>(drawn_labels(volume, labels_of(volume), shown));
}

/// Unlit labels on black: 1 red, 2 blue, 3 green.
Shot label_shot(const std::vector<bool>& shown, double extinction) {
    Shot shot;
    shot.volume = label_volume(shown);
    shot.scene = two_tone(0, extinction);
    shot.scene.lights.clear();
    shot.scene.label_colors = {glm::dvec3(0), kRed, kBlue, {0, 1, 0}};
    shot.camera = look(*shot.volume, {-14, 3, 21}, {11.5, 11.5, 11.5}, 40, {0, 0, 1});
    shot.width = 72;
    shot.height = 60;
    return shot;
}

Image cast(const Shot& shot) {
    Shot least = shot;  // makes render() set this volume in the renderer
    least.width = least.height = 1;
    render(least);
    return test_renderer().raycast(shot.scene, shot.camera, shot.settings, {}, shot.width, shot.height).color;
}

/// The largest share of a colour's channel in a picture.
float most_of(const Image& image, int channel) {
    float most = 0;
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x)
            most = std::max(most, image.at(x, y, channel));
    return most;
}

double rms_between(const Image& a, const Image& b) {
    double square = 0;
    for (std::size_t i = 0; i < a.pixels.size(); ++i)
        square += std::pow(static_cast<double>(a.pixels[i] - b.pixels[i]), 2);
    return std::sqrt(square / static_cast<double>(a.pixels.size()));
}

TEST(Labels, NoColourIsShownThatIsNotThere) {
    for (const double extinction : {8.0, 0.3}) {
        const Shot all = label_shot({false, true, true, true}, extinction);
        for (const Image& image : {render(all).color, cast(all)}) {
            EXPECT_GT(most_of(image, 0), 0.5);
            EXPECT_GT(most_of(image, 1), 0.4);
            EXPECT_GT(most_of(image, 2), 0.4);
            for (int y = 0; y < image.height; ++y)
                for (int x = 0; x < image.width; ++x) {
                    const float sum = image.at(x, y, 0) + image.at(x, y, 1) + image.at(x, y, 2);
                    // Pure colours in any mixture: their sum is the opacity.
                    EXPECT_NEAR(sum, image.at(x, y, 3), 2e-3) << x << ' ' << y;
                }
        }
        // Without labels 1 and 3, only label 2 is left: nothing has another label's colour, not even at rims.
        const Shot one = label_shot({false, false, true, false}, extinction);
        for (const Image& image : {render(one).color, cast(one)}) {
            EXPECT_EQ(most_of(image, 0), 0);
            EXPECT_EQ(most_of(image, 1), 0);
            EXPECT_GT(most_of(image, 2), 0.4);
        }
    }
}

TEST(Labels, DoNotChangeTheSurface) {
    Shot labels = label_shot({false, true, true, true}, 8), mask = labels;
    mask.scene.label_colors.clear();
    const Image colored = render(labels).color, plain = render(mask).color;
    for (int y = 0; y < plain.height; ++y)
        for (int x = 0; x < plain.width; ++x)
            EXPECT_EQ(colored.at(x, y, 3), plain.at(x, y, 3));
}

/// A smooth ball whose segmentation has one half and a neighbour outside of it.
Shot segmented_shot(double extinction) {
    Volume scan, segmentation;
    scan.geometry.dims = segmentation.geometry.dims = glm::ivec3(24);
    for (int z = 0; z < 24; ++z)
        for (int y = 0; y < 24; ++y)
            for (int x = 0; x < 24; ++x) {
                const glm::dvec3 from = glm::dvec3(x, y, z) - glm::dvec3(11.6, 11.3, 11.4);
                scan.values.push_back(static_cast<float>(1 / (1 + std::exp(2 * (glm::length(from) - 7)))));
                segmentation.values.push_back(glm::length(from) < 7 && x < 12 ? 1.0F : 0.0F);
            }
    finish_volume(segmentation);
    finish_volume(scan);
    add_segmentation(scan, segmentation);
    Shot shot = label_shot({false, true, true, true}, extinction);
    shot.volume = std::make_shared<const Volume>(std::move(scan));
    shot.scene.materials[1].color = kBlue;
    shot.scene.label_colors = {kRed};
    shot.camera = look(*shot.volume, {13, -18, 18}, {11.5, 11.5, 11.5}, 40, {0, 0, 1});
    return shot;
}

TEST(Labels, ColourTheMatterOfScans) {
    const Shot both = segmented_shot(8);
    Shot plain = both;
    plain.scene.label_colors.clear();
    const auto [image, blue] = std::pair(render(both).color, render(plain).color);
    const Image rays = cast(both);
    int red_pixels = 0, blue_pixels = 0, others = 0;
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x) {
            // The surface is the scan's own one, in either colour.
            EXPECT_EQ(image.at(x, y, 3), blue.at(x, y, 3));
            EXPECT_EQ(image.at(x, y, 1), 0);
            EXPECT_EQ(rays.at(x, y, 1), 0);
            if (image.at(x, y, 3) < 0.99F) continue;
            (image.at(x, y, 0) > 0.99F ? red_pixels : blue_pixels) += 1;
            others += (image.at(x, y, 0) > 0.5F) != (rays.at(x, y, 0) > 0.5F) ? 1 : 0;
        }
    EXPECT_GT(red_pixels, 300);
    EXPECT_GT(blue_pixels, 300);
    EXPECT_LT(others, 60) << "along the line between both colours";
}

TEST(Labels, OfScansLookAsInTheReference) {
    for (const double extinction : {8.0, 0.4}) {
        Shot shot = segmented_shot(extinction);
        shot.scene.lights = {Light{}};
        shot.width = shot.height = 20;
        const Image device = render(shot).color;
        const Image exact =
            reference::render(*shot.volume, shot.scene, shot.camera, shot.settings, shot.width, shot.height);
        EXPECT_LT(rms_between(device, exact), 4e-3) << extinction;
    }
}

TEST(Labels, LookAsInTheReference) {
    // Translucent: voxels beside labels have splats, too.
    Shot shot = label_shot({false, true, true, true}, 0.4);
    shot.scene.lights = {Light{}};
    shot.width = shot.height = 20;
    const Image device = render(shot).color;
    const Image exact =
        reference::render(*shot.volume, shot.scene, shot.camera, shot.settings, shot.width, shot.height);
    EXPECT_LT(rms_between(device, exact), 4e-3);
}

TEST(Labels, AreThousands) {
    Volume volume;
    volume.geometry.dims = glm::ivec3(40, 40, 12);
    for (int i = 0; i < 40 * 40 * 12; ++i)
        volume.values.push_back(0);
    auto table = std::make_shared<LabelTable>();
    table->labels.push_back({0, 0, {}, {}});
    std::uint64_t id = 5'000'000'000;
    for (int z = 1; z < 11; ++z)
        for (int y = 1; y < 39; ++y)
            for (int x = 1; x < 39; ++x) {
                volume.values[static_cast<std::size_t>(x + 40 * (y + 40 * z))] =
                    static_cast<float>(table->labels.size());
                table->labels.push_back({id++, static_cast<float>(table->labels.size()), {}, {}});
            }
    volume.labels = table;
    finish_volume(volume);
    Shot shot;
    shot.volume = std::make_shared<const Volume>(drawn_labels(volume));
    shot.scene = two_tone(0, 8);
    shot.scene.lights.clear();
    // The label of each voxel column says where it is.
    shot.scene.label_colors.assign(table->labels.size(), glm::dvec3(0));
    for (std::size_t place = 1; place < table->labels.size(); ++place)
        shot.scene.label_colors[place] = glm::dvec3(static_cast<double>((place - 1) % 38) / 37, 0.2, 0);
    shot.camera = look(*shot.volume, {19.5, 19.5, -60}, {19.5, 19.5, 5}, 30, {0, 1, 0});
    const Image image = render(shot).color;
    float last = -1;
    std::vector<float> row;
    for (int x = 0; x < image.width; ++x)
        if (image.at(x, 32, 3) > 0.99F) row.push_back(image.at(x, 32, 0));
    ASSERT_GT(row.size(), 20U);
    if (row.front() > row.back()) std::ranges::reverse(row);
    for (const float red : row) {
        EXPECT_GT(red, last - 0.01F);
        last = red;
    }
    EXPECT_LT(row.front(), 0.1F);
    EXPECT_GT(row.back(), 0.9F);
}

/// Balls of three labels inside each other, radii 14, 9 and 4 voxels.
Volume nested_balls() {
    Volume volume;
    volume.geometry.dims = glm::ivec3(32);
    for (int i = 0; i < 32 * 32 * 32; ++i) {
        const double r = glm::length(glm::dvec3(i % 32, i / 32 % 32, i / 1024) - glm::dvec3(15.3, 15.6, 15.4));
        volume.values.push_back(r < 4 ? 3 : r < 9 ? 2 : r < 14 ? 1 : 0);
    }
    finish_volume(volume);
    return volume;
}

/// What a scene shows on the ray through the balls' middle: unlit labels 1 red, 2 green, 3 blue.
glm::dvec3 in_the_middle(const SceneDocument& document) {
    static const Volume balls = nested_balls();
    Shot shot;
    SceneDocument all = document;
    shot.volume = std::make_shared<const Volume>(prepared_volume(all, balls));
    read_volumes(all, {}, {}, &balls);
    shot.scene = resolve_scene(all, *shot.volume);
    const std::vector<glm::dvec3> colors{glm::dvec3(0), {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    shot.scene.label_colors = colors;
    for (AddedVolume& added : shot.scene.added)
        added.label_colors = colors;
    shot.scene.lights.clear();
    shot.camera = look(balls, {15.3, 15.6, -400}, {15.3, 15.6, 15.4}, 2, {0, 1, 0});
    shot.width = shot.height = 9;
    const Image image = render(shot).color;
    return {image.at(4, 4, 0), image.at(4, 4, 1), image.at(4, 4, 2)};
}

TEST(Labels, ThatFadeShowTheWholeNextSurface) {
    SceneDocument document;
    document.volume.path = "balls";
    const auto expect_near = [](const glm::dvec3& seen, const glm::dvec3& expected) {
        EXPECT_LT(glm::length(seen - expected), 0.02) << seen.x << ' ' << seen.y << ' ' << seen.z;
    };
    expect_near(in_the_middle(document), {1, 0, 0});
    // The share of each shell, 5 voxels thick, in front of the next ball.
    const auto share = [](double opacity, double outer, double inner) {
        const double chord = 4.0 / 3 * (std::pow(outer, 3) - std::pow(inner, 3)) / (outer * outer + inner * inner);
        return -std::expm1(std::log1p(-opacity) * (outer - inner) / chord);
    };
    fade_labels(document, "1", 0.3);
    const double first = share(0.3, 14, 9), second = share(0.6, 9, 4);
    expect_near(in_the_middle(document), {first, 1 - first, 0});
    fade_labels(document, "2", 0.6);
    expect_near(in_the_middle(document), {first, (1 - first) * second, (1 - first) * (1 - second)});
    document.volume.hide = {"1", "2"};
    document.volumes.erase(document.volumes.begin());
    expect_near(in_the_middle(document), {0, second, 1 - second});
    document.volumes.clear();
    expect_near(in_the_middle(document), {0, 0, 1});
}

}  // namespace
}  // namespace edgesplat::test
