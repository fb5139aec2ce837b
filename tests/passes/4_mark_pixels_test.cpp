// The pixels that are marked for the entries of tile lists, against footprints in double precision.
#include <gtest/gtest.h>

#include <cstdio>

#include "tests/passes/pass_fixture.h"

namespace edgesplat::test {
namespace {

constexpr std::uint32_t kTile = shader::TILE;

struct Marked {
    std::size_t touched = 0;  ///< pairs of an entry and a pixel in its footprint
    std::size_t marked = 0;   ///< pairs that are marked
    std::size_t missed = 0;   ///< touched and not marked
    double peak = 0;          ///< largest optical depth of an entry
    double most_missed = 0;   ///< largest optical depth where it is not marked
};

/// Draws so that the last chunk contains splats.
void draw(DeviceUnderTest& state, const PassScene& s, const glm::ivec2& size) {
    FramePlan plan = state.drawer.plan(state.level.all(), s.scene, s.camera, s.settings, size, shader::PAYLOAD_COLOR);
    plan.params.chunk_slots = 0;
    state.drawer.draw(state.level.all(), plan);
}

/// Counts the marks of the last chunk. `cell`: pixels per mark.
Marked count_marks(DeviceUnderTest& state, const PassScene& s, const glm::ivec2& size, const glm::uvec2& cell) {
    const auto records = device_records(state);
    const Oracle oracle(s, records, size);
    const glm::uvec2 tiles(state.plan().params.tiles), cells = kTile / cell;
    const auto ranges = download<glm::uvec2>(state, state.targets().tile_ranges, std::size_t{tiles.x} * tiles.y);
    const std::size_t entries = ranges.back().y;
    const auto list = download<glm::uvec2>(state, state.targets().tile_entries, entries);
    const auto order =
        download<std::uint32_t>(state, state.targets().order, state.targets().drawn.mapped<std::uint32_t>(1)[0]);
    const std::size_t words = std::size_t{cells.x} * cells.y;
    const auto marks =
        download<std::uint32_t>(state, state.targets().tile_marks, (entries / shader::MARKED_AT_ONCE + 1) * words);
    Marked out;
    for (std::uint32_t tile = 0; tile < ranges.size(); ++tile) {
        for (std::uint32_t i = ranges[tile].x; i < ranges[tile].y; ++i) {
            const std::uint32_t splat = order[list[i].x];
            for (std::uint32_t y = 0; y < kTile; ++y) {
                for (std::uint32_t x = 0; x < kTile; ++x) {
                    const glm::uvec2 pixel(tile % tiles.x * kTile + x, tile / tiles.x * kTile + y);
                    if (pixel.x >= static_cast<std::uint32_t>(size.x) || pixel.y >= static_cast<std::uint32_t>(size.y))
                        continue;
                    const double tau = oracle.drawer.tau(splat, static_cast<int>(pixel.x), static_cast<int>(pixel.y));
                    const bool touched = tau > 0;
                    const std::size_t word = i / shader::MARKED_AT_ONCE * words + y / cell.y * cells.x + x / cell.x;
                    const bool marked = (marks[word] >> i % shader::MARKED_AT_ONCE & 1U) != 0;
                    out.touched += touched ? 1 : 0;
                    out.marked += marked ? 1 : 0;
                    out.missed += touched && !marked ? 1 : 0;
                    out.peak = std::max(out.peak, tau);
                    if (!marked) out.most_missed = std::max(out.most_missed, tau);
                }
            }
        }
    }
    return out;
}

TEST(MarkPixels, MarksEveryPixelOfAFootprintAndFewOthers) {
    const glm::ivec2 size(70, 45);  // neither side is a multiple of a tile's
    std::size_t touched = 0;
    for (const auto& [edges, footprints, warp] :
         {std::tuple{EdgeEstimator::Cubic, FootprintMode::Procedural, WarpFamily::Face},
          std::tuple{EdgeEstimator::March, FootprintMode::Procedural, WarpFamily::Paper},
          std::tuple{EdgeEstimator::Taylor, FootprintMode::Warp2d, WarpFamily::Paper},
          std::tuple{EdgeEstimator::Off, FootprintMode::Isotropic, WarpFamily::Face}}) {
        for (PassScene s : pass_scenes()) {
            SCOPED_TRACE(fmt::format("{} {} {}", s.name, name_of(footprints), name_of(warp)));
            s.settings.edges = edges;
            s.settings.footprints = footprints;
            s.settings.warp = warp;
            s.settings.pixels = PixelChoice::Every;
            s.settings.saturation = 1;  // no tile becomes saturated
            s.settings = canonical_settings(s.settings);
            DeviceUnderTest& state = prepared(s);
            draw(state, s, size);
            const Marked marks = count_marks(state, s, size, {1, 1});
            touched += marks.touched;
            // Footprints that are warped in two dimensions have small values outside the kernel's support.
            if (footprints == FootprintMode::Warp2d)
                EXPECT_LE(marks.most_missed, 5e-4 * marks.peak);
            else
                EXPECT_EQ(marks.missed, 0U);
            if (marks.touched < 1000) continue;  // the last chunk has only a few splats
            const double share = static_cast<double>(marks.marked) / static_cast<double>(marks.touched);
            std::printf("%-18s %-10s %-6s marked per touched pixel: %.3f\n", s.name.c_str(),
                        std::string(name_of(footprints)).c_str(), std::string(name_of(warp)).c_str(), share);
            // The supports of cut and warped kernels only fill a part of their bounding spheres.
            EXPECT_LE(share, footprints == FootprintMode::Isotropic ? 1.1 : 3.3);
        }
    }
    EXPECT_GT(touched, 400000U);
}

TEST(MarkPixels, MarksWholeCellsOfRefinedPixels) {
    if (!device_under_test().device().profile().refines) GTEST_SKIP() << "this device draws every pixel";
    for (PassScene s : pass_scenes()) {
        SCOPED_TRACE(s.name);
        const glm::ivec2 size(150, 121);
        s.settings.saturation = 1;
        DeviceUnderTest& state = prepared(s);
        draw(state, s, size);
        ASSERT_TRUE(state.plan().refined);
        const Marked marks = count_marks(state, s, size, {4, 2});
        EXPECT_GT(marks.touched, 10000U);
        EXPECT_EQ(marks.missed, 0U);
        EXPECT_LT(static_cast<double>(marks.marked), 3.8 * static_cast<double>(marks.touched));
    }
}

TEST(MarkPixels, MarksWholeCellsInVeryLargePictures) {
    for (PassScene s : pass_scenes()) {
        SCOPED_TRACE(s.name);
        const glm::ivec2 size(70, 45);
        s.settings.saturation = 1;
        s.settings.pixels = PixelChoice::Every;
        DeviceUnderTest& state = prepared(s);
        const auto pixels = [&] {
            const auto mapped = state.targets().output.mapped<glm::vec4>(static_cast<std::size_t>(size.x * size.y));
            return std::vector<glm::vec4>(mapped.begin(), mapped.end());
        };
        draw(state, s, size);
        const auto want = pixels();
        ASSERT_FALSE(state.plan().wide_marks);
        FramePlan plan = state.plan();
        plan.wide_marks = true;
        state.drawer.draw(state.level.all(), plan);
        EXPECT_EQ(count_marks(state, s, size, {4, 2}).missed, 0U);
        // Outside a support, rounding leaves a footprint of at most about 1e-8.
        const auto got = pixels();
        for (std::size_t i = 0; i < got.size(); ++i)
            ASSERT_LT(glm::length(got[i] - want[i]), 1e-6F) << i;
    }
    EXPECT_TRUE(plan_frame(pass_scenes()[0].volume, pass_scenes()[0].scene, pass_scenes()[0].camera, {}, {8192, 4096},
                           shader::PAYLOAD_COLOR, {1000, glm::ivec3(0), glm::ivec3(9)}, 2.5)
                    .wide_marks);
}

TEST(MarkPixels, MarksAllPixelsForSplatsAroundTheEye) {
    // The eye is inside a voxel: a support that may reach the eye has no conic.
    PassScene s = pass_scenes()[2];
    look_at(s, {11.6, 12.4, 11.3}, {13, 13, 12}, 100);
    s.settings.pixels = PixelChoice::Every;
    s.settings.saturation = 1;
    const glm::ivec2 size(48, 33);
    DeviceUnderTest& state = prepared(s);
    draw(state, s, size);
    const Marked marks = count_marks(state, s, size, {1, 1});
    EXPECT_GT(marks.touched, 10000U);
    EXPECT_EQ(marks.missed, 0U);
}

}  // namespace
}  // namespace edgesplat::test
