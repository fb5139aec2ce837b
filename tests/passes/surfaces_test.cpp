// Surface splats on the device: their faces and pictures against the reference, and no trace of them where kernels
// draw.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "engine/reference/reference_renderer.h"
#include "engine/volume/labels.h"
#include "tests/passes/traced_scenes.h"

namespace edgesplat::test {
namespace {

constexpr glm::ivec2 kSurfacesSize{96, 80};

PassScene of_volume(const std::string& builtin, const glm::dvec3& eye, const glm::dvec3& target, double fov) {
    PassScene s;
    s.name = builtin;
    const AnalyticScene scene = builtin_scene("builtin:" + builtin);
    s.volume = sample(scene);
    s.scene.iso_values = {scene.iso_values.back()};
    s.scene.materials = {{{0, 0, 0}, 0}, {{1, 0.85, 0.75}, 8}};
    look_at(s, eye, target, fov);
    return s;
}

/// Planes cut a gyroid in its middle; they cut a corner out of a torus.
std::vector<PassScene> cut_scenes() {
    std::vector<PassScene> scenes;
    scenes.push_back(of_volume("gyroid", {90, -60, 80}, {19, 19, 19}, 30));
    scenes.back().name = "cut gyroid";
    scenes.back().scene.effects.clip.keep = {{{19, 18, 21}, {0.3, -1, 0.2}}};
    scenes.push_back(of_volume("torus:28", {13, -34, 30}, {13, 13, 13}, 40));
    scenes.back().name = "torus without a corner";
    scenes.back().scene.effects.clip.remove = {{{13, 0, 0}, {1, 0, 0}}, {{0, 13, 0}, {0.1, 1, 0}}};
    return scenes;
}

/// Two nested opaque materials, cut; the inner one shows in the cut alone. The lowest values are matter, too.
PassScene nested() {
    PassScene s = of_volume("ellipsoid:26", {40, -30, 36}, {12, 12, 12}, 30);
    s.name = "nested";
    s.scene.iso_values = {0.05, 0.4, 0.7};
    s.scene.materials = {{{0.2, 1, 0.3}, 6}, {{0, 0, 0}, 0}, {{1, 0.3, 0.2}, 6}, {{0.3, 0.4, 1}, 8}};
    s.scene.effects.clip.keep = {{{12, 12, 12}, {0.2, -1, 0.6}}};
    return s;
}

/// A ball of two labels.
PassScene labelled_ball() {
    PassScene s;
    s.name = "labels";
    Volume ball;
    ball.geometry.dims = glm::ivec3(18);
    for (int z = 0; z < 18; ++z)
        for (int y = 0; y < 18; ++y)
            for (int x = 0; x < 18; ++x)
                ball.values.push_back(glm::length(glm::dvec3(x, y, z) - 8.5) > 6 ? 0.0F : x + z < 17 ? 1.0F : 2.0F);
    finish_volume(ball);
    s.volume = drawn_labels(ball);
    s.scene.iso_values = {0.5};
    s.scene.materials = {{}, {.extinction = 8}};
    s.scene.label_colors = {glm::dvec3(0), {1, 0.3, 0.1}, {0.1, 0.4, 1}};
    s.scene.effects.clip.keep = {{{8, 8, 8}, {0.1, 1, 0.3}}};
    look_at(s, {20, 40, 30}, {8, 8, 8}, 28);
    return s;
}

/// Smooth, noisy, thin, cut by the border, of two values only; a torus on an oblique left-handed grid; cut by planes,
/// of several materials or labels, with occluded ambient light, shadows or smooth outlines, and seen from within.
std::vector<PassScene> surface_scenes() {
    std::vector<PassScene> scenes = traced_scenes();
    scenes.push_back(pass_scenes()[0]);
    scenes.push_back(pass_scenes()[0]);
    scenes.back().name = "oblique torus";
    auto& geometry = scenes.back().volume.geometry;
    geometry.index_to_world_axes =
        glm::dmat3(glm::dvec3(0.9, 0.2, 0.1), glm::dvec3(0.2, -1.1, 0.15), glm::dvec3(0.1, 0.3, 1.7));
    scenes.back().scene.materials[1].extinction = 8;
    look_at(scenes.back(), {13, -14, 24}, {13, 12, 9}, 40);
    scenes.push_back(of_volume("torus:28:noise=0.04", {13, -14, 30}, {13, 13, 13}, 40));
    scenes.push_back(of_volume("cube-hole:24", {30, -18, 34}, {12, 12, 12}, 32));
    for (const PassScene& s : cut_scenes())
        scenes.push_back(s);
    scenes.push_back(nested());
    scenes.push_back(labelled_ball());
    scenes.push_back(cut_scenes().front());
    scenes.back().name = "occluded";
    scenes.back().scene.effects.occlusion = AmbientOcclusion{.strength = 1, .radius = 6};
    scenes.back().scene.ambient = 0.8;
    // A ball over a slab of soft matter, through which the second surface is seen; one light at a point.
    scenes.push_back(pass_scenes()[0]);
    scenes.back().name = "shadowed";
    scenes.back().scene.lights = {directional_light({0.5, -0.4, 0.7}),
                                  Light{.kind = Light::Kind::Point, .shadows = true}};
    scenes.back().scene.lights[0].shadows = true;
    scenes.back().scene.lights[1].position = scenes.back().volume.geometry.to_world({30, 10, 40});
    for (const std::size_t i : {0U, 2U}) {
        scenes.push_back(traced_scenes()[i]);
        scenes.back().name += ", outlines";
        scenes.back().scene.effects.smooth_outlines = true;
    }
    scenes.push_back(pass_scenes()[0]);
    scenes.back().name = "eye in thin matter";
    scenes.back().scene.materials[1].extinction = 5;
    look_at(scenes.back(), {21.3, 13, 9.2}, {13, 12, 9}, 70);
    scenes.push_back(of_volume("cube-hole:24", {30, -18, 34}, {12, 12, 12}, 32));
    scenes.back().name += ", outlines";
    scenes.back().scene.effects.smooth_outlines = true;
    for (PassScene& s : scenes)
        s.settings.opaque = OpaqueMatter::Surfaces;
    return scenes;
}

reference::PreparedVolume reference_of(const PassScene& s) {
    return {s.volume, s.scene, s.settings, true};
}

TEST(Surfaces, HaveTheReferencesFaces) {
    for (const PassScene& s : surface_scenes()) {
        SCOPED_TRACE(s.name);
        DeviceUnderTest& state = prepared(s);
        ASSERT_TRUE(state.lists().surfaces);
        const reference::PreparedVolume prepared_volume = reference_of(s);
        std::vector<reference::SplatRecord> expected = prepared_volume.surfaces();
        sort_by_brick(expected, s.volume.geometry.dims);
        const std::vector<reference::SplatRecord> got = device_records(state);
        ASSERT_EQ(got.size(), expected.size());
        std::size_t traced = 0, creased = 0, different = 0;
        for (std::size_t i = 0; i < got.size(); ++i) {
            const reference::VoxelEdge &a = got[i].edge, &b = expected[i].edge;
            ASSERT_EQ(got[i].voxel, expected[i].voxel);
            traced += b.traced ? 1U : 0U;
            creased += std::isfinite(b.crease.D) ? 1U : 0U;
            bool same = a.traced == b.traced && std::isfinite(a.crease.D) == std::isfinite(b.crease.D);
            // A refused face is known by its error alone; one that is never drawn has no other meaning.
            const bool drawn = !b.traced || b.D2 < 1;
            if (drawn) same = same && std::abs(a.D - b.D) < 4e-3 && glm::length(a.n - b.n) < 4e-3;
            if (b.traced && b.D2 < 1) same = same && std::abs(a.D2 - b.D2) < 0.02;
            different += same ? 0U : 1U;
        }
        std::printf("%-22s %5zu splats, %4zu traced, %3zu creased, %zu different\n", s.name.c_str(), got.size(), traced,
                    creased, different);
        // Whether a face is kept is a comparison, which rounding can turn.
        EXPECT_LE(different, 2 + got.size() / 100);
    }
}

TEST(Surfaces, LookLikeTheReferences) {
    for (const PassScene& s : surface_scenes()) {
        SCOPED_TRACE(s.name);
        DeviceUnderTest& state = prepared(s);
        Settings every = s.settings;
        every.pixels = PixelChoice::Every;
        state.draw(s.scene, s.camera, every, kSurfacesSize, shader::PAYLOAD_COLOR);
        const auto pixels = state.targets().output.mapped<glm::vec4>(96 * 80);
        const Image expected = reference_of(s).render(s.camera, kSurfacesSize.x, kSurfacesSize.y);
        double squares = 0, alphas = 0;
        for (std::size_t i = 0; i < pixels.size(); ++i)
            for (int c = 0; c < 4; ++c) {
                const double want = static_cast<double>(expected.pixels[4 * i + static_cast<std::size_t>(c)]);
                const double off = static_cast<double>(pixels[i][c]) - want;
                squares += off * off;
                alphas += c == 3 && want > 0.5 ? 1 : 0;
            }
        const double psnr = -10 * std::log10(squares / (4.0 * static_cast<double>(pixels.size())) + 1e-20);
        std::printf("%-22s %.1f dB\n", s.name.c_str(), psnr);
        // The device samples a searched ray once a voxel, the reference ten times: a gyroid of this size has pieces
        // that are thinner. One pixel of 7,680 is worth 39 dB.
        const bool thin = s.volume.name.find("gyroid") != std::string::npos || s.name == "gyroid";
        // It takes the slope along such a ray as linear, to find its outline.
        const bool searched = s.name == "opening, outlines" || s.name == "cut, outlines";
        EXPECT_GE(psnr, thin ? 33 : searched ? 45 : 55);
        EXPECT_GT(alphas, 400);
    }
}

/// Bricks behind closed tiles are left out; the picture is the same.
TEST(Surfaces, HideBricksWithoutChangingAPixel) {
    PassScene s = of_volume("gyroid", {90, -60, 80}, {19, 19, 19}, 30);
    s.settings.opaque = OpaqueMatter::Surfaces;
    s.settings.pixels = PixelChoice::Every;
    DeviceUnderTest& state = prepared(s);
    const auto drawn = [&](bool bricks, std::uint64_t least) {
        state.drawer.set_culling({.bricks = bricks, .min_splats_to_hide = least});
        state.draw(s.scene, s.camera, s.settings, kSurfacesSize, shader::PAYLOAD_COLOR);
        const auto pixels = state.targets().output.mapped<glm::vec4>(96 * 80);
        return std::vector<glm::vec4>(pixels.begin(), pixels.end());
    };
    const auto all = drawn(false, 1), some = drawn(true, 1);
    state.drawer.set_culling({.bricks = false});
    std::size_t different = 0;
    for (std::size_t i = 0; i < all.size(); ++i)
        different += glm::all(glm::lessThan(glm::abs(all[i] - some[i]), glm::vec4(1e-5F))) ? 0U : 1U;
    EXPECT_EQ(different, 0U);
}

/// The same votes in another place of the lists: a view from far away, where rays are nearly parallel and all splats of
/// a face lie in other sheets.
TEST(Surfaces, DoNotDependOnTheSpacingOfSheets) {
    for (const PassScene& scene : {surface_scenes()[1], surface_scenes()[3]}) {
        PassScene s = scene;
        SCOPED_TRACE(s.name);
        s.settings.pixels = PixelChoice::Every;
        std::vector<std::vector<glm::vec4>> pictures;
        for (const double spacing : {0.25, 0.11}) {
            s.settings.sheet_spacing = spacing;
            DeviceUnderTest& state = prepared(s);
            state.draw(s.scene, s.camera, s.settings, kSurfacesSize, shader::PAYLOAD_COLOR);
            const auto pixels = state.targets().output.mapped<glm::vec4>(96 * 80);
            pictures.emplace_back(pixels.begin(), pixels.end());
        }
        std::size_t different = 0;
        for (std::size_t i = 0; i < pictures[0].size(); ++i)
            different += glm::all(glm::lessThan(glm::abs(pictures[0][i] - pictures[1][i]), glm::vec4(0.02F))) ? 0U : 1U;
        EXPECT_LE(different, pictures[0].size() / 500);
    }
}

/// What earlier pictures left in the buffer of votes is never used, in particular not as a splat's number.
TEST(Surfaces, DoNotDependOnEarlierVotes) {
    PassScene s = labelled_ball();
    s.settings.opaque = OpaqueMatter::Surfaces;
    s.settings.pixels = PixelChoice::Every;
    for (const bool cut : {true, false}) {
        if (!cut) s.scene.effects.clip.keep.clear();
        DeviceUnderTest& state = prepared(s);
        const auto drawn = [&] {
            state.draw(s.scene, s.camera, s.settings, kSurfacesSize, shader::PAYLOAD_COLOR);
            const auto pixels = state.targets().output.mapped<glm::vec4>(96 * 80);
            return std::vector<glm::vec4>(pixels.begin(), pixels.end());
        };
        const auto first = drawn();
        state.commands().run([&] {
            state.commands().fill(state.targets().tile_sheets, 0x4b000000);
            state.commands().barrier();
        });
        EXPECT_TRUE(drawn() == first);
    }
}

/// Kernels draw scenes with effects that surface splats do not have.
TEST(Surfaces, LeaveOtherScenesToKernels) {
    PassScene s = surface_scenes()[3];
    EXPECT_TRUE(draws_surfaces(s.settings, s.scene, s.volume));
    const auto draws = [&](const auto& change) {
        PassScene changed = s;
        change(changed);
        return draws_surfaces(changed.settings, changed.scene, changed.volume);
    };
    EXPECT_FALSE(draws([](PassScene& c) { c.settings.opaque = OpaqueMatter::Kernels; }));
    EXPECT_FALSE(draws([](PassScene& c) { c.scene.materials[1].extinction = 0.5; }));
    EXPECT_FALSE(draws([](PassScene& c) { c.settings.edges = EdgeEstimator::March; }));
    EXPECT_FALSE(draws([](PassScene& c) { c.settings.sheets = SheetCut::Sliced; }));
    EXPECT_FALSE(draws([](PassScene& c) { c.settings.footprints = FootprintMode::Table; }));
    EXPECT_FALSE(draws([](PassScene& c) { c.scene.effects.antialias = true; }));
    EXPECT_FALSE(draws([](PassScene& c) {
        c.scene.effects.occlusion = AmbientOcclusion{};
        c.scene.effects.clip.remove = {{{0, 0, 0}, {1, 0, 0}}};
    }));
    EXPECT_FALSE(draws([](PassScene& c) {
        c.scene.lights = {directional_light({0, 0, 1})};
        c.scene.lights[0].shadows = true;
        c.scene.effects.clip.remove = {{{0, 0, 0}, {1, 0, 0}}};
    }));
    DeviceUnderTest& state = prepared(s);
    EXPECT_TRUE(state.lists().surfaces);
    s.settings.opaque = OpaqueMatter::Kernels;
    EXPECT_TRUE(state.collect(s.scene, s.settings)) << "another list";
    EXPECT_FALSE(state.lists().surfaces);
}

}  // namespace
}  // namespace edgesplat::test
