// Culling of bricks: which bricks are culled, and that the picture does not change.
#include <cstdio>
#include <random>

#include "tests/passes/pass_fixture.h"
#include "tests/unit/reference_volumes.h"

namespace edgesplat::test {
namespace {

/// Surfaces throughout 52 x 44 x 37 voxels, some opaque, on an oblique grid.
PassScene waves() {
    PassScene s;
    s.name = "waves";
    s.volume = testing_volumes::sampled(
        {52, 44, 37},
        [](const glm::dvec3& p) {
            return std::sin(p.x / 3.1) * std::cos(p.y / 2.7) + std::sin(p.y / 3.3) * std::cos(p.z / 2.9) +
                   std::sin(p.z / 3.7) * std::cos(p.x / 3.5);
        },
        glm::dmat3(glm::dvec3(0.9, 0.2, 0.1), glm::dvec3(0.2, -1.1, 0.15), glm::dvec3(0.1, 0.3, 1.4)));
    s.volume.geometry.origin = {-20, 12, 7};
    s.scene.iso_values = {0.4, 1.1};
    s.scene.materials = {{{0, 0, 0}, 0}, {{0.3, 0.5, 1}, 0.15}, {{1, 0.8, 0.3}, 3}};
    s.scene.lights = {directional_light({0.3, -1, 0.5})};
    return s;
}

/// Eyes in and around the volume, with various directions.
std::vector<Camera> cameras_of(const PassScene& s, int count) {
    std::mt19937 random(5);
    std::uniform_real_distribution<double> in_unit(0, 1);
    const auto point = [&](double scale) {
        const glm::dvec3 dims(s.volume.geometry.dims);
        return dims * (0.5 + scale * (glm::dvec3(in_unit(random), in_unit(random), in_unit(random)) - 0.5));
    };
    std::vector<Camera> cameras;
    for (int i = 0; i < count; ++i) {
        PassScene at = s;
        look_at(at, point(i % 3 == 0 ? 0.9 : i % 3 == 1 ? 2.5 : 10), point(1.1), i % 2 == 0 ? 75 : 20);
        cameras.push_back(at.camera);
    }
    return cameras;
}

/// Distant eyes with a side of the picture through the volume. Voxels are smaller than pixels.
std::vector<Camera> cameras_past(const PassScene& s, const glm::ivec2& size, int count) {
    std::vector<Camera> cameras;
    const glm::dvec3 middle = s.volume.geometry.to_world(0.5 * glm::dvec3(s.volume.geometry.dims));
    for (int i = 0; i < count; ++i) {
        Camera camera;
        camera.fov_y = i % 2 == 0 ? 70 : 30;
        camera.up = {0.1, 0.05, 1};
        const double angle = 1.7 * i;
        camera.eye = middle + (i % 2 == 0 ? 500.0 : 1500.0) * glm::dvec3(std::cos(angle), std::sin(angle), 0.3);
        camera.direction = middle - camera.eye;
        const CameraFrame frame = camera_frame(camera);
        const double past = 0.95 + 0.02 * (i % 6);
        camera.direction = frame.forward;
        if (i % 3 != 1) camera.direction += past * frame.tan_half_y * (i % 4 < 2 ? 1.0 : -1.0) * frame.up;
        if (i % 3 != 0)
            camera.direction += past * frame.tan_half_y * size.x / size.y * (i % 4 > 1 ? 1.0 : -1.0) * frame.right;
        cameras.push_back(camera);
    }
    return cameras;
}

constexpr glm::ivec2 kSize{53, 38};

struct Frame {
    std::vector<glm::vec4> pixels;
    std::uint32_t drawn = 0;
    std::uint64_t culled = 0;
};

Frame frame(DeviceUnderTest& state, const PassScene& s, const Camera& camera, std::uint32_t payload, bool culls,
            const glm::dvec2& offset = {0, 0}) {
    state.drawer.set_culling({.bricks = culls});
    state.draw(s.scene, camera, canonical_settings(s.settings, s.scene), kSize, payload, offset);
    state.drawer.set_culling({.bricks = false});
    const auto pixels = state.targets().output.mapped<glm::vec4>(static_cast<std::size_t>(kSize.x * kSize.y));
    return {{pixels.begin(), pixels.end()},
            state.targets().drawn.mapped<std::uint32_t>(1)[0],
            state.plan().params.splat_count - state.plan().splats_examined};
}

/// Expects that culling changes no picture of any camera. Returns (culled splats, all splats), summed.
glm::u64vec2 expect_nothing_lost(const PassScene& s, const std::vector<Camera>& cameras,
                                 std::uint32_t payload = shader::PAYLOAD_COLOR, const glm::dvec2& offset = {0, 0}) {
    DeviceUnderTest& state = prepared(s);
    glm::u64vec2 sums(0);
    int number = 0;
    for (const Camera& camera : cameras) {
        SCOPED_TRACE(number++);
        const Frame all = frame(state, s, camera, payload, false, offset);
        const Frame culled = frame(state, s, camera, payload, true, offset);
        EXPECT_TRUE(all.pixels == culled.pixels);
        // Pixel filters may widen a splat's box without a contribution there.
        if (!s.scene.effects.antialias) {
            EXPECT_EQ(all.drawn, culled.drawn);
        }
        EXPECT_EQ(all.culled, 0U);
        EXPECT_LE(culled.drawn + culled.culled, state.lists().splat_count * state.plan().sheets_per_splat);
        sums += glm::u64vec2(culled.culled, state.lists().splat_count);
    }
    return sums;
}

TEST(CullBricks, ChangesNoPixel) {
    const glm::u64vec2 culled = expect_nothing_lost(waves(), cameras_of(waves(), 30));
    EXPECT_GT(culled.x, culled.y / 5) << "one brick in five should be outside of these pictures";
}

TEST(CullBricks, ChangesNoPixelOfOtherOutputsAndSettings) {
    PassScene s = waves();
    const std::vector<Camera> cameras = cameras_of(s, 5);
    EXPECT_GT(expect_nothing_lost(s, cameras, shader::PAYLOAD_TAU).x, 0U);
    EXPECT_GT(expect_nothing_lost(s, cameras, shader::PAYLOAD_DEPTH_DISTANCE, {0.5, -0.5}).x, 0U);
    s.settings.sheets = SheetCut::Sliced;
    EXPECT_GT(expect_nothing_lost(s, cameras).x, 0U);
    s.settings = layered({});
    if (layers_obstacle().empty()) {
        EXPECT_EQ(expect_nothing_lost(s, cameras).x, 0U) << "layers draw all splats";
    }
    s.settings = {};
    s.settings.edges = EdgeEstimator::Off;
    EXPECT_GT(expect_nothing_lost(s, cameras).x, 0U);
    s.settings = {};
    s.scene.effects.antialias = true;
    EXPECT_GT(expect_nothing_lost(s, cameras).x, 0U);
    EXPECT_GT(expect_nothing_lost(s, cameras_past(s, kSize, 24)).x, 0U);
    s.scene.effects.antialias = false;
    s.scene.effects.clip.keep = {Plane{s.volume.geometry.to_world({25, 20, 18}), {0, 0.3, 1}}};
    EXPECT_GT(expect_nothing_lost(s, cameras).x, 0U);
}

/// 44 x 120 x 37 voxels of cavities between two walls with a few holes.
PassScene cavities() {
    PassScene s;
    s.name = "cavities";
    s.volume = testing_volumes::sampled({44, 120, 37}, [](const glm::dvec3& p) {
        const double cavity = std::sin(p.x / 3.1) + std::sin(p.y / 2.7) + std::sin(p.z / 2.9);
        const bool in_wall = (p.y > 3 && p.y < 9) || (p.y > 110 && p.y < 116);
        const double hole = 8 - 2 * std::hypot(p.x - 12, p.z - 25);
        return in_wall ? std::min(-hole, 2.0) : -cavity;
    });
    s.scene.iso_values = {0.4, 1.1};
    s.scene.materials = {{{0, 0, 0}, 0}, {{0.3, 0.5, 1}, 4}, {{1, 0.8, 0.3}, 3}};
    s.scene.lights = {directional_light({0.3, -1, 0.5})};
    return s;
}

TEST(HiddenBricks, ChangeNoPixelWhenSkipped) {
    PassScene s = cavities();
    DeviceUnderTest& state = prepared(s);
    if (!state.device().profile().front_first) GTEST_SKIP() << "this profile does not draw frames in two parts";
    ASSERT_TRUE(state.level.splats.collected()->buried);
    const glm::ivec2 size(150, 110);
    const auto pixels = [&](const Camera& camera, std::uint32_t payload, std::uint64_t least) {
        state.drawer.set_culling({.bricks = true, .min_splats_to_hide = least});
        state.draw(s.scene, camera, canonical_settings(s.settings, s.scene), size, payload);
        state.drawer.set_culling({.bricks = false});
        const auto mapped = state.targets().output.mapped<glm::vec4>(static_cast<std::size_t>(size.x * size.y));
        return std::vector<glm::vec4>(mapped.begin(), mapped.end());
    };
    std::uint64_t all = 0, splats_examined = 0;
    for (int i = 0; i < 12; ++i) {
        SCOPED_TRACE(i);
        // Voxels are two to three pixels wide.
        const double side = i % 2 == 0 ? -1 : 1;
        look_at(s, glm::dvec3(22 + 4 * (i % 5), 60 + side * (140 + 5 * i), 18 - 3 * (i % 4)), {22, 60, 18}, 17 + i);
        for (const std::uint32_t payload : {shader::PAYLOAD_COLOR, shader::PAYLOAD_DEPTH_DISTANCE}) {
            const auto want = pixels(s.camera, payload, ~std::uint64_t{0});
            all += state.plan().splats_examined;
            const std::uint32_t drawn = state.targets().drawn.mapped<std::uint32_t>(1)[0];
            EXPECT_TRUE(pixels(s.camera, payload, 100) == want);
            splats_examined += state.plan().splats_examined;
            EXPECT_LE(state.targets().drawn.mapped<std::uint32_t>(1)[0], drawn);
        }
        // In pictures of optical depth nothing is hidden, and the frame is not divided.
        const auto tau = pixels(s.camera, shader::PAYLOAD_TAU, ~std::uint64_t{0});
        const std::uint64_t once = state.plan().splats_examined;
        EXPECT_TRUE(pixels(s.camera, shader::PAYLOAD_TAU, 100) == tau);
        EXPECT_EQ(state.plan().splats_examined, once);
    }
    std::printf("%.3f of the splats in view examined\n",
                static_cast<double>(splats_examined) / static_cast<double>(all));
    EXPECT_LT(static_cast<double>(splats_examined), 0.9 * static_cast<double>(all));
}

TEST(CullBricks, IteratesNoBrickOutsideTheView) {
    PassScene s = waves();
    DeviceUnderTest& state = prepared(s);
    look_at(s, {25, -30, 20}, {25, -60, 20}, 40);
    const Frame away = frame(state, s, s.camera, shader::PAYLOAD_COLOR, true);
    EXPECT_EQ(away.culled, state.lists().splat_count);
    EXPECT_EQ(away.drawn, 0U);
    EXPECT_TRUE(away.pixels == frame(state, s, s.camera, shader::PAYLOAD_COLOR, false).pixels);
}

TEST(CullBricks, BricksMatchTheSplatList) {
    const PassScene s = waves();
    DeviceUnderTest& state = prepared(s);
    const auto records = device_records(state);
    const glm::ivec3 dims = s.volume.geometry.dims;
    std::size_t next = 0;
    for (const SplatBrick& brick : state.lists().bricks.bricks()) {
        ASSERT_EQ(brick.first, next);
        EXPECT_GT(brick.count, 0U);
        for (std::uint32_t i = 0; i < brick.count; ++i, ++next) {
            const auto voxel = static_cast<int>(records[next].voxel);
            const glm::ivec3 p(voxel % dims.x, voxel / dims.x % dims.y, voxel / dims.x / dims.y);
            EXPECT_EQ(glm::clamp(p, brick.box.low, brick.box.high), p);
        }
        EXPECT_TRUE(glm::all(glm::lessThan(brick.box.high - brick.box.low, glm::ivec3(8))));
    }
    EXPECT_EQ(next, records.size());
}

TEST(CullBricks, PartsContainEveryVisibleSplat) {
    // Compared with a test of every single brick; gaps shorter than the limit are closed.
    std::mt19937 random(11);
    std::vector<SplatBrick> bricks;
    std::uint32_t first = 0;
    for (int i = 0; i < 700; ++i) {
        const glm::ivec3 low = 8 * glm::ivec3(i % 9, i / 9 % 10, i / 90);
        bricks.push_back({{low, low + 7}, first, 1 + static_cast<std::uint32_t>(random() % 60)});
        first += bricks.back().count;
    }
    SplatBricks tree;
    tree.assign(bricks);
    EXPECT_EQ(tree.count(), bricks.size());
    const PassScene s = waves();
    for (const Camera& camera : cameras_of(s, 40)) {
        const ViewVolume view(s.volume.geometry, camera, {64, 48});
        const std::vector<std::uint32_t> numbers = tree.in_view(view, 2);
        const std::vector<ListPart> exact = tree.parts_of(numbers, 1), parts = tree.parts_of(numbers, 64);
        std::vector<bool> in_exact(first), in_parts(first);
        for (const ListPart& part : exact)
            std::fill(in_exact.begin() + part.first, in_exact.begin() + part.end, true);
        for (const ListPart& part : parts)
            std::fill(in_parts.begin() + part.first, in_parts.begin() + part.end, true);
        for (const SplatBrick& brick : bricks) {
            const bool shows = view.shows(brick.box.low, brick.box.high - brick.box.low + 1, 2);
            for (std::uint32_t i = brick.first; i < brick.first + brick.count; ++i) {
                ASSERT_EQ(in_exact[i], shows);
                ASSERT_TRUE(in_parts[i] || !shows);
            }
        }
        std::uint64_t splats_examined = 0;
        for (const glm::uvec2& batch : batches_of(parts)) {
            EXPECT_TRUE(batch.y > 0 && batch.y <= shader::SPLAT_BATCH);
            splats_examined += batch.y;
        }
        EXPECT_EQ(splats_examined, static_cast<std::uint64_t>(std::ranges::count(in_parts, true)));
        EXPECT_LE(batches_of(parts).size() * shader::SPLAT_BATCH, first + shader::SPLAT_BATCH - 1);
        for (std::size_t i = 1; i < parts.size(); ++i)
            EXPECT_GE(parts[i].first - parts[i - 1].end, 64U);
    }
}

}  // namespace
}  // namespace edgesplat::test
