// Opaque matter drawn by surface splats behind translucent matter drawn by kernels: on the device and by the reference.
#include <gmock/gmock.h>

#include <cmath>
#include <cstdio>
#include <numeric>

#include "engine/reference/reference_renderer.h"
#include "engine/scene/mixture.h"
#include "tests/passes/pass_fixture.h"

namespace edgesplat::test {
namespace {

using testing::ElementsAre;

constexpr glm::ivec2 kSize{72, 60};

constexpr double kMiddle = 14.7;  // of the balls, voxels

/// Depth below a ball's surface of radius 13, voxels.
Volume ball() {
    Volume volume;
    volume.geometry.dims = glm::ivec3(30);
    for (int z = 0; z < 30; ++z)
        for (int y = 0; y < 30; ++y)
            for (int x = 0; x < 30; ++x)
                volume.values.push_back(static_cast<float>(13 - glm::length(glm::dvec3(x, y, z) - kMiddle)));
    finish_volume(volume);
    return volume;
}

/// A ball of radius 6 in a translucent shell.
PassScene shell() {
    PassScene s;
    s.name = "shell";
    s.volume = ball();
    s.scene.iso_values = {1, 7};
    s.scene.materials = {{}, {{0.3, 0.5, 1}, 0.12}, {{1, 0.8, 0.5}, 8}};
    s.scene.lights = {directional_light({0.4, -0.5, 0.6})};
    s.scene.lights[0].shadows = false;
    s.settings.pixels = PixelChoice::Every;
    look_at(s, {48, -26, 40}, glm::dvec3(kMiddle), 28);
    return s;
}

/// The torus's field with translucent and opaque layers between four iso-values, on an oblique left-handed grid.
PassScene layers() {
    PassScene s = pass_scenes()[0];
    s.name = "oblique layers";
    s.volume.geometry.index_to_world_axes =
        glm::dmat3(glm::dvec3(0.9, 0.2, 0.1), glm::dvec3(0.2, -1.1, 0.15), glm::dvec3(0.1, 0.3, 1.3));
    s.scene.iso_values = {0.2, 0.45, 0.7, 0.9};
    s.scene.materials = {{{0.2, 0.9, 0.4}, 0.01}, {}, {{0.3, 0.5, 1}, 0.3}, {{1, 0.8, 0.3}, 8}, {{1, 0.2, 0.2}, 9}};
    s.settings = shell().settings;
    look_at(s, {13, -14, 24}, {13, 12, 9}, 40);
    return s;
}

std::vector<PassScene> mixed_scenes() {
    std::vector<PassScene> scenes{shell(), layers()};
    const auto add = [&](const char* name, const auto& change) {
        scenes.push_back(shell());
        scenes.back().name = name;
        change(scenes.back());
    };
    add("cut", [](PassScene& s) { s.scene.effects.clip.keep = {{{15, 15, 15}, {0.3, -1, 0.2}}}; });
    add("without a corner", [](PassScene& s) {
        s.scene.effects.clip.remove = {{{15, 0, 0}, {1, 0, 0}}, {{0, 15, 0}, {0.1, -1, 0}}};
    });
    add("thin layer", [](PassScene& s) {
        // Some light passes, and matter of both kinds is behind.
        s.scene.iso_values = {1, 4.6, 5.7};
        s.scene.materials = {{}, {{0.3, 0.5, 1}, 0.12}, {{1, 0.8, 0.5}, 4.1}, {{0.2, 1, 0.3}, 0.1}};
    });
    add("eye in the shell", [](PassScene& s) { look_at(s, {23, 7, 18}, glm::dvec3(kMiddle), 70); });
    add("eye in the core", [](PassScene& s) { look_at(s, glm::dvec3(kMiddle), {26, 15, 17}, 70); });
    add("opaque outside", [](PassScene& s) {
        s.scene.iso_values = {1, 4};
        s.scene.materials = {{}, {{1, 0.8, 0.5}, 8}, {{0.3, 0.5, 1}, 0.12}};
        s.scene.effects.clip.keep = {{{15, 15, 15}, {0.3, -1, 0.2}}};
    });
    add("occluded", [](PassScene& s) {
        s.scene.effects.occlusion = AmbientOcclusion{.strength = 1, .radius = 6};
        s.scene.ambient = 0.8;
    });
    add("shadowed", [](PassScene& s) {
        s.scene.lights[0].shadows = true;
        s.scene.materials[1].extinction = 0.05;
    });
    add("outlines", [](PassScene& s) { s.scene.effects.smooth_outlines = true; });
    add("refined", [](PassScene& s) {
        s.settings.pixels = PixelChoice::Refined;
        look_at(s, {30, 2, 22}, glm::dvec3(kMiddle), 30);
    });
    return scenes;
}

/// PSNR without the worst pixel of 200: where a ray only touches a surface, rounding decides.
double decibels_of_most(std::span<const glm::vec4> got, const Image& want) {
    std::vector<double> squares(got.size(), 0);
    for (std::size_t i = 0; i < got.size(); ++i)
        for (int c = 0; c < 4; ++c)
            squares[i] +=
                std::pow(static_cast<double>(got[i][c] - want.pixels[4 * i + static_cast<std::size_t>(c)]), 2);
    std::ranges::sort(squares);
    squares.resize(squares.size() - squares.size() / 200);
    const double sum = std::accumulate(squares.begin(), squares.end(), 0.0);
    return -10 * std::log10(sum / (4.0 * static_cast<double>(squares.size())) + 1e-20);
}

TEST(Mixture, LooksLikeTheReferences) {
    for (const PassScene& s : mixed_scenes()) {
        SCOPED_TRACE(s.name);
        DeviceUnderTest& state = prepared(s);
        ASSERT_TRUE(state.level.surfaces.lists().surfaces);
        ASSERT_FALSE(state.lists().surfaces);
        state.draw(s.scene, s.camera, s.settings, kSize, shader::PAYLOAD_COLOR);
        const reference::PreparedVolume reference(s.volume, s.scene, s.settings, true);
        const Image expected = reference.render(s.camera, kSize.x, kSize.y);
        const double psnr = decibels_of_most(
            state.targets().output.mapped<glm::vec4>(static_cast<std::size_t>(kSize.x * kSize.y)), expected);
        std::printf("%-18s %.1f dB\n", s.name.c_str(), psnr);
        EXPECT_GE(psnr, 55);
    }
}

/// Depths and normals are of both kinds of matter.
TEST(Mixture, HasTheReferencesOutputs) {
    const PassScene s = shell();
    DeviceUnderTest& state = prepared(s);
    const reference::PreparedVolume reference(s.volume, s.scene, s.settings, true);
    for (const auto& [payload, output, channels, scale] :
         {std::tuple{shader::PAYLOAD_DEPTH_DISTANCE, reference::Output::Depth, 1, 40.0},
          {shader::PAYLOAD_NORMAL, reference::Output::Normal, 3, 1.0}}) {
        state.draw(s.scene, s.camera, s.settings, kSize, payload);
        const auto pixels = state.targets().output.mapped<glm::vec4>(static_cast<std::size_t>(kSize.x * kSize.y));
        const Image expected = reference.render(s.camera, kSize.x, kSize.y, output);
        double squares = 0, most = 0;
        for (std::size_t i = 0; i < pixels.size(); ++i)
            for (int c = 0; c < channels; ++c) {
                if (pixels[i].a < 0.01F) continue;
                const auto at = i * static_cast<std::size_t>(channels) + static_cast<std::size_t>(c);
                squares += std::pow(static_cast<double>(pixels[i][c] - expected.pixels[at]) / scale, 2);
                most = std::max(most, std::abs(static_cast<double>(expected.pixels[at])) / scale);
            }
        EXPECT_GT(most, 0.5);
        EXPECT_GE(-10 * std::log10(squares / static_cast<double>(pixels.size()) + 1e-20), 45) << payload;
    }
}

/// An unlit ball in a shell: along a ray, the shell's light is that of its length, and the ball hides the rest.
TEST(Mixture, IsExactForAnUnlitBallInAShell) {
    PassScene s;
    s.volume = ball();
    const glm::dvec3 middle(kMiddle);
    constexpr double kBall = 6, kShell = 12, kExtinction = 0.08;
    s.scene.iso_values = {13 - kShell, 13 - kBall};
    s.scene.materials = {{}, {{0.3, 0.5, 1}, kExtinction}, {{1, 0.8, 0.5}, 8}};
    s.scene.lights.clear();
    look_at(s, {48, -26, 40}, glm::dvec3(kMiddle), 28);
    s.settings.pixels = PixelChoice::Every;
    const reference::View view(s.camera, s.volume.geometry, kSize.x, kSize.y);
    const auto exact = [&](int x, int y) {
        const glm::dvec3 from = view.eye_index - middle, u = view.ray(x, y);
        const double b = glm::dot(from, u), across2 = glm::dot(from, from) - b * b;
        const double shell = std::sqrt(std::max(kShell * kShell - across2, 0.0));
        const bool hits = across2 < kBall * kBall;
        const double length = hits ? shell - std::sqrt(kBall * kBall - across2) : 2 * shell;
        const double through = std::exp(-kExtinction * length);
        return glm::dvec4((1 - through) * s.scene.materials[1].color, 1 - through) +
               (hits ? through * glm::dvec4(s.scene.materials[2].color, 1) : glm::dvec4(0));
    };
    std::vector<double> errors;
    for (const OpaqueMatter opaque : {OpaqueMatter::Surfaces, OpaqueMatter::Kernels}) {
        s.settings.opaque = opaque;
        DeviceUnderTest& state = prepared(s);
        state.draw(s.scene, s.camera, s.settings, kSize, shader::PAYLOAD_COLOR);
        const auto pixels = state.targets().output.mapped<glm::vec4>(static_cast<std::size_t>(kSize.x * kSize.y));
        double squares = 0;
        for (int y = 0; y < kSize.y; ++y)
            for (int x = 0; x < kSize.x; ++x) {
                const auto i = static_cast<std::size_t>(y * kSize.x + x);
                const glm::dvec3 from = view.eye_index - middle;
                const double beside = glm::length(glm::cross(from, view.ray(x, y)));
                // One ray a pixel: where it only touches the ball, it sees all of it or nothing.
                if (std::abs(beside - kBall) < 0.1) continue;
                const glm::dvec4 off = glm::dvec4(pixels[i]) - exact(x, y);
                squares += glm::dot(off, off);
            }
        errors.push_back(-10 * std::log10(squares / (4.0 * kSize.x * kSize.y)));
    }
    std::printf("unlit ball in a shell: %.1f dB, by kernels alone %.1f dB\n", errors[0], errors[1]);
    EXPECT_GE(errors[0], 48);
    EXPECT_GE(errors[0], errors[1]);
}

/// Bricks behind closed tiles are left out; the picture is the same.
TEST(Mixture, HidesBricksWithoutChangingAPixel) {
    PassScene s = shell();
    look_at(s, {27, 8, 20}, glm::dvec3(kMiddle), 40);  // the core fills most of the picture
    DeviceUnderTest& state = prepared(s);
    const auto drawn = [&](bool bricks, std::uint64_t least) {
        state.drawer.set_culling({.bricks = bricks, .min_splats_to_hide = least});
        state.draw(s.scene, s.camera, s.settings, kSize, shader::PAYLOAD_COLOR);
        const auto pixels = state.targets().output.mapped<glm::vec4>(static_cast<std::size_t>(kSize.x * kSize.y));
        return std::vector<glm::vec4>(pixels.begin(), pixels.end());
    };
    const auto all = drawn(false, 1), some = drawn(true, 1);
    const std::uint64_t examined = state.drawer.splats_examined();
    state.drawer.set_culling({.bricks = false});
    EXPECT_LT(examined, state.lists().splat_count + state.level.surfaces.lists().splat_count);
    for (std::size_t i = 0; i < all.size(); ++i)
        ASSERT_TRUE(glm::all(glm::lessThan(glm::abs(all[i] - some[i]), glm::vec4(1e-4F)))) << i;
}

/// A colour or an extinction changes the picture, not the lists.
TEST(Mixture, KeepsBothListsWhenAColourChanges) {
    PassScene s = shell();
    DeviceUnderTest& state = prepared(s);
    s.scene.materials[1].color = {1, 0, 0};
    s.scene.materials[1].extinction = 0.2;
    s.scene.materials[2].color = {0, 1, 0};
    EXPECT_FALSE(state.collect(s.scene, s.settings));
    s.scene.materials[1].extinction = 0;
    EXPECT_TRUE(state.collect(s.scene, s.settings)) << "the surfaces alone";
    EXPECT_FALSE(state.level.surfaces.collected());
    EXPECT_EQ(state.level.surfaces.lists().splat_count, 0U);
}

TEST(Mixture, DividesAScene) {
    const PassScene s = layers();
    const auto mixture = mixture_of(s.settings, s.scene, s.volume);
    ASSERT_TRUE(mixture);
    const auto extinctions = [](const Scene& scene) {
        std::vector<double> all;
        for (const Material& material : scene.materials)
            all.push_back(material.extinction);
        return all;
    };
    EXPECT_THAT(extinctions(mixture->surfaces), ElementsAre(0, 0, 0, 8, 9));
    EXPECT_EQ(mixture->surfaces.iso_values, s.scene.iso_values);
    // The translucent layer continues into the opaque matter, so no edge is between them.
    EXPECT_THAT(extinctions(mixture->kernels), ElementsAre(0.01, 0, 0.3));
    EXPECT_THAT(mixture->kernels.iso_values, ElementsAre(0.2, 0.45));

    const auto divides = [&](const auto& change) {
        PassScene changed = shell();
        change(changed);
        return mixture_of(changed.settings, changed.scene, changed.volume).has_value();
    };
    EXPECT_TRUE(divides([](PassScene&) {}));
    EXPECT_FALSE(divides([](PassScene& c) { c.scene.materials[1].extinction = 0; })) << "all matter is opaque";
    EXPECT_FALSE(divides([](PassScene& c) { c.scene.materials[2].extinction = 1; })) << "none is opaque";
    EXPECT_FALSE(divides([](PassScene& c) { c.settings.opaque = OpaqueMatter::Kernels; }));
    EXPECT_FALSE(divides([](PassScene& c) { c.settings.sheet_format = SheetFormat::Layers; }));
    EXPECT_FALSE(divides([](PassScene& c) { c.scene.effects.antialias = true; }));
    // One material fills the volume around opaque matter: its iso-value stays, for the volume's border.
    PassScene fog = shell();
    fog.scene.iso_values = {0.5};
    fog.scene.materials = {{{0.5, 0.5, 0.5}, 0.01}, {{1, 1, 1}, 8}};
    const auto in_fog = mixture_of(fog.settings, fog.scene, fog.volume);
    ASSERT_TRUE(in_fog);
    EXPECT_THAT(extinctions(in_fog->kernels), ElementsAre(0.01, 0.01));
}

/// Voxels deep in opaque matter are no splats, though its kernels continue into it.
TEST(Mixture, CollectsNothingDeepInOpaqueMatter) {
    const PassScene s = shell();
    DeviceUnderTest& state = prepared(s);
    ASSERT_TRUE(state.level.splats.collected()->buried);
    std::size_t deepest = 0;
    for (const shader::Splat& splat : download<shader::Splat>(state, state.lists().splats, state.lists().splat_count))
        deepest += splat.voxel == 15 + 30 * (15 + 30 * 15) ? 1U : 0U;
    EXPECT_EQ(deepest, 0U);
    Settings kept = s.settings;
    kept.cull_buried = false;
    const std::uint64_t culled = state.lists().splat_count;
    state.collect(s.scene, kept);
    EXPECT_GT(state.lists().splat_count, culled);
}

}  // namespace
}  // namespace edgesplat::test
