// A volume that the device holds block by block gives the same picture as the whole volume.
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <functional>
#include <limits>

#include "engine/error.h"
#include "engine/forecast/effect_table.h"
#include "engine/forecast/forecast.h"
#include "engine/renderer.h"
#include "engine/store/blocks.h"
#include "engine/volume/load_volume.h"
#include "engine/volume/pack_volume.h"
#include "tests/properties/scenes.h"

namespace edgesplat::test {
namespace {

/// Surfaces everywhere, also across every border between blocks: a bent gyroid.
VolumePointer gyroid(const glm::ivec3& dims) {
    return sampled(
        dims,
        [](const glm::dvec3& p) {
            const glm::dvec3 q =
                (p + glm::dvec3(0.2, 0.7, 0.4) + 2.0 * glm::sin(glm::dvec3(p.y, p.z, p.x) / 9.0)) / 4.3;
            return std::sin(q.x) * std::cos(q.y) + std::sin(q.y) * std::cos(q.z) + std::sin(q.z) * std::cos(q.x);
        },
        glm::dmat3(glm::dvec3(1, 0.1, 0), glm::dvec3(0, 0.9, 0.05), glm::dvec3(0, 0, 1.3)));
}

Shot gyroid_shot(const glm::ivec3& dims = {300, 28, 16}) {
    Shot shot;
    shot.volume = gyroid(dims);
    shot.scene.iso_values = {0.2, 0.9};
    shot.scene.materials = {{}, {{0.2, 0.5, 1}, 0.15}, {{1, 0.85, 0.7}, 2}};
    shot.camera = look(*shot.volume, {150, 40, 130}, {150, 12, 8}, 95);
    shot.width = shot.height = 128;
    return shot;
}

/// Sets a memory budget, and removes it at the end of the test.
struct Budget {
    explicit Budget(std::uint64_t bytes) { test_renderer().set_memory_budget(bytes); }
    Budget(const Budget&) = delete;
    Budget& operator=(const Budget&) = delete;
    ~Budget() { test_renderer().set_memory_budget(0); }
};

/// Bytes of the volume's own images in a picture's forecast.
std::uint64_t bytes_of_images(const Shot& shot) {
    const FrameRequest request{shot.volume, shot.scene, shot.camera, shot.settings, {shot.width, shot.height}, {}};
    std::uint64_t bytes = 0;
    for (const PlannedResource& resource : test_renderer().forecast(request).resources)
        if (resource.image && resource.image->volume) bytes += test_renderer().required_bytes(resource);
    return bytes;
}

struct Pair {
    RenderResult whole, blocks;
};

/// Draws the whole volume, and then in blocks, which a finite patience causes.
Pair both(const Shot& shot, const AovRequest& aovs = {}) {
    Pair pair;
    pair.whole = render(shot, aovs);
    EXPECT_FALSE(pair.whole.stats.in_blocks);
    test_renderer().set_patience(1e9);
    pair.blocks = render(shot, aovs);
    test_renderer().set_patience(std::numeric_limits<double>::infinity());
    EXPECT_TRUE(pair.blocks.stats.in_blocks && pair.blocks.stats.complete);
    return pair;
}

/// The mean squared difference is below a billionth of the squared range.
void expect_equal(const Pair& pair, const char* what) {
    EXPECT_GE(compare_images(pair.blocks.color, pair.whole.color).psnr, 90) << what;
    EXPECT_GT(pair.blocks.stats.splats_collected, 10000U) << what;
}

TEST(Blocks, MatchTheWholeVolumeInLessMemory) {
    const Shot shot = gyroid_shot({300, 182, 14});
    const RenderResult whole = render(shot);
    EXPECT_FALSE(whole.stats.in_blocks);
    const std::uint64_t bytes = whole.stats.device_bytes - bytes_of_images(shot) / 8;
    const Budget budget(bytes);
    const RenderResult blocks = render(shot);
    EXPECT_TRUE(blocks.stats.in_blocks);
    EXPECT_EQ(blocks.stats.blocks, 6U);
    EXPECT_EQ(blocks.stats.blocks_held, 6U);
    EXPECT_LE(blocks.stats.device_bytes, bytes);
    expect_equal({whole, blocks}, "");
    EXPECT_EQ(blocks.stats.splats_collected, whole.stats.splats_collected);
    EXPECT_EQ(blocks.stats.edge_splats, whole.stats.edge_splats);
}

TEST(Blocks, MatchTheWholeVolumeWithEveryKindOfSplat) {
    for (const char* what : {"march", "taylor", "paper", "plain", "sliced"}) {
        Shot shot = gyroid_shot();
        const std::string name = what;
        if (name == "march") shot.settings.edges = EdgeEstimator::March;
        if (name == "paper") shot.settings = paper_settings(shot.settings);
        if (name == "taylor") shot.settings.edges = EdgeEstimator::Taylor;
        if (name == "plain") shot.settings.edges = EdgeEstimator::Off;
        if (name == "sliced") shot.settings.sheets = SheetCut::Sliced;
        expect_equal(both(shot), what);
    }
}

TEST(Blocks, MatchTheWholeVolumeWithEffects) {
    Shot cut = gyroid_shot();
    cut.scene.effects.clip.keep.push_back({cut.volume->geometry.to_world({129, 0, 0}), {1, 0.2, 0.1}});
    expect_equal(both(cut), "clip");
    const Pair tau = both(gyroid_shot(), {.tau = true});
    const double range = static_cast<double>(std::ranges::max(tau.whole.tau->pixels));
    EXPECT_GT(range, 1);
    EXPECT_GE(compare_images(*tau.blocks.tau, *tau.whole.tau).psnr + 20 * std::log10(range), 90);
}

/// A rod of five blocks with a wall across its beginning, and surfaces everywhere behind it.
Shot walled_rod() {
    Shot shot;
    const auto behind = gyroid({20, 20, 600});
    shot.volume = sampled({20, 20, 600}, [&](const glm::dvec3& p) {
        const auto at = static_cast<std::size_t>(p.x + 20 * (p.y + 20 * p.z));
        return std::abs(p.z - 30) <= 2 ? 2.0 : p.z < 60 ? -2.0 : static_cast<double>(behind->values[at]);
    });
    shot.scene.iso_values = {0.2};
    shot.scene.materials = {{}, {{1, 0.85, 0.7}, 4}};
    shot.camera = look(*shot.volume, {9.5, 9.5, -60}, {9.5, 9.6, 0}, 9);
    shot.width = shot.height = 96;
    return shot;
}

TEST(Blocks, AreSkippedIfOccluded) {
    // In blocks, rays find no faces.
    Shot shot = walled_rod();
    shot.settings.edges = EdgeEstimator::March;
    const Pair before = both(shot);
    EXPECT_EQ(before.blocks.stats.blocks, 5U);
    EXPECT_EQ(before.blocks.stats.blocks_held, 1U);
    EXPECT_LT(before.blocks.stats.splats_collected, before.whole.stats.splats_collected / 3);
    // A saturated pixel may stop earlier, at the end of the front blocks.
    EXPECT_GE(compare_images(before.blocks.color, before.whole.color).psnr, 80);
    EXPECT_GE(std::ranges::min(before.whole.color.pixels), 0.0F);

    // Beside the wall everything behind it is visible; from the other end, everything that end does not occlude.
    Shot beside = shot;
    beside.camera = look(*shot.volume, {60, 9.5, -60}, {9.5, 9.6, 100}, 60);
    const Pair past = both(beside);
    EXPECT_EQ(past.blocks.stats.blocks_held, 5U);
    EXPECT_GE(compare_images(past.blocks.color, past.whole.color).psnr, 90);
    Shot end = shot;
    end.camera = look(*shot.volume, {9.5, 9.5, 700}, {9.5, 9.6, 0}, 7);
    const Pair other = both(end);
    EXPECT_GE(compare_images(other.blocks.color, other.whole.color).psnr, 90);
}

TEST(Blocks, AreAllCollectedIfNeeded) {
    Shot unsaturated = walled_rod();
    unsaturated.settings.saturation = 1;
    EXPECT_EQ(both(unsaturated).blocks.stats.blocks_held, 5U);
    EXPECT_EQ(both(walled_rod(), {.tau = true}).blocks.stats.blocks_held, 5U);
    Shot clear = walled_rod();
    clear.scene.materials.back().extinction = 0.05;
    EXPECT_EQ(both(clear).blocks.stats.blocks_held, 5U);
}

/// Deleted at the end of the test.
struct PackedFile {
    explicit PackedFile(const Volume& volume) { pack_volume(volume, path); }
    PackedFile(const PackedFile&) = delete;
    PackedFile& operator=(const PackedFile&) = delete;
    ~PackedFile() { std::filesystem::remove(path); }
    std::string path = testing::TempDir() + "blocks_test_" + std::to_string(::getpid()) + ".esv";
};

TEST(Blocks, FromAFileMatchTheVolumeInMemory) {
    Shot shot = gyroid_shot();
    const RenderResult whole = render(shot);
    const PackedFile file(*shot.volume);
    shot.volume = std::make_shared<const Volume>(load_volume(file.path));
    ASSERT_TRUE(shot.volume->values.empty());
    const RenderResult packed = render(shot);
    EXPECT_TRUE(packed.stats.in_blocks && packed.stats.complete);
    expect_equal({whole, packed}, "packed");
    EXPECT_EQ(packed.stats.splats_collected, whole.stats.splats_collected);
    // With far less memory a coarser level is drawn and reported.
    std::uint64_t bytes = packed.stats.device_bytes;
    RenderResult coarser = packed;
    for (; coarser.stats.level == 0 && bytes > packed.stats.device_bytes / 4; bytes -= bytes / 10) {
        const Budget budget(bytes);
        coarser = render(shot);
        EXPECT_LE(coarser.stats.device_bytes, bytes);
    }
    EXPECT_EQ(coarser.stats.level, 1);
    EXPECT_EQ(coarser.stats.wanted_level, 0);
    EXPECT_GE(compare_images(coarser.color, whole.color).psnr, 15);
    const Budget budget(100'000);
    EXPECT_THROW(render(shot), Error);
}

TEST(Blocks, AreHeldIfVisible) {
    Shot shot = gyroid_shot();
    shot.camera = look(*shot.volume, {30, 12, 60}, {30, 12, 0}, 30);
    const Pair corner = both(shot);
    expect_equal(corner, "corner");
    EXPECT_EQ(corner.blocks.stats.blocks_held, 1U);
    EXPECT_LT(corner.blocks.stats.splats_collected, corner.whole.stats.splats_collected / 2);
}

TEST(Blocks, AreFreedIfNoLongerVisible) {
    Shot shot = gyroid_shot({900, 28, 16});
    const std::array<double, 4> places = {30, 330, 630, 898};
    const auto at = [&](double x) {
        shot.camera = look(*shot.volume, {x, 12, 60}, {x, 12, 0}, 30);
        return render(shot);
    };
    test_renderer().set_patience(1e9);
    std::array<RenderResult, 4> roomy;
    for (std::size_t i = 0; i < places.size(); ++i)
        roomy[i] = at(places[i]);
    const std::uint64_t most = roomy.back().stats.blocks_held;
    EXPECT_GE(most, 4U) << "there is room for more than the visible blocks";
    // The smallest budget for these pictures is between half of this and all of it.
    std::uint64_t fewest = most;
    for (double share = 0.95; share > 0.5; share -= 0.05) {
        SCOPED_TRACE(share);
        const auto bytes = static_cast<std::uint64_t>(share * static_cast<double>(roomy.back().stats.device_bytes));
        const Budget budget(bytes);
        for (std::size_t i = 0; i < places.size(); ++i)
            try {
                const RenderResult again = at(places[i]);
                EXPECT_LE(again.stats.device_bytes, bytes);
                // If a ray barely touches a face, rounding decides: one or two pixels may differ.
                EXPECT_GE(compare_images(again.color, roomy[i].color).psnr, 65);
                fewest = std::min(fewest, again.stats.blocks_held);
            } catch (const Error& refused) {
                EXPECT_NE(std::string(refused.what()).find("the memory budget"), std::string::npos);
            }
    }
    EXPECT_LE(fewest, most - 2);
    test_renderer().set_patience(std::numeric_limits<double>::infinity());
}

/// A rod of eight blocks along x, seen from `distance`: one block from nearby, all from far away.
Shot long_shot(double x, double distance) {
    static const VolumePointer volume = gyroid({900, 28, 16});
    Shot shot = gyroid_shot({20, 20, 16});
    shot.volume = volume;
    shot.settings.saturation = 1;  // no block occludes another
    shot.camera = look(*volume, {x, 12, distance}, {x, 12, 0}, 30);
    return shot;
}

/// After `ends_early` has started the whole rod and collected its second block, that block is drawn.
void expect_second_block_after(const std::function<void(const Shot&)>& ends_early) {
    test_renderer().set_patience(1e9);
    EXPECT_EQ(render(long_shot(30, 60)).stats.blocks_held, 1U);
    ends_early(long_shot(450, 900));
    const Shot second = long_shot(190, 60);
    test_renderer().set_patience(1e9);
    const RenderResult blocks = render(second);
    test_renderer().set_patience(std::numeric_limits<double>::infinity());
    EXPECT_TRUE(blocks.stats.in_blocks && blocks.stats.complete);
    EXPECT_EQ(blocks.stats.blocks_held, 2U);
    EXPECT_GE(compare_images(blocks.color, render(second).color).psnr, 90);
}

TEST(Blocks, AreKeptAfterAnUnfinishedPicture) {
    expect_second_block_after([](const Shot& all) {
        test_renderer().set_patience(0);
        EXPECT_FALSE(render(all).stats.complete);
    });
}

TEST(Blocks, AreKeptAfterAnInterruptedPicture) {
    expect_second_block_after([](const Shot& all) {
        int asked = 0;
        test_renderer().set_interruption([&] { return ++asked > 1; });
        EXPECT_THROW(render(all), Interrupted);
        test_renderer().set_interruption({});
    });
}

TEST(Blocks, AreReplacedByACoarserLevelUntilCollected) {
    const Shot shot = gyroid_shot();
    const RenderResult whole = render(shot);
    test_renderer().set_patience(0);
    std::vector<RenderResult> shown;
    do
        shown.push_back(render(shot));
    while (!shown.back().stats.complete && shown.size() < 10);
    test_renderer().set_patience(std::numeric_limits<double>::infinity());
    ASSERT_EQ(shown.size(), 3U) << "one block per picture";
    EXPECT_EQ(shown[0].stats.level, 1);
    EXPECT_EQ(shown[0].stats.wanted_level, 0);
    EXPECT_EQ(shown[2].stats.level, 0);
    EXPECT_EQ(shown[2].stats.validation_messages, 0U);
    EXPECT_GE(compare_images(shown[0].color, whole.color).psnr, 15) << "similar to the whole picture";
    EXPECT_GE(compare_images(shown.back().color, whole.color).psnr, 90);
    EXPECT_EQ(compare_images(shown[0].color, shown[1].color).rmse, 0) << "the coarse picture does not change";
}

/// Radius minus distance from the middle of 384^3 voxels, as a file source with bounds only.
class Ball : public SampleSource {
  public:
    Ball() { geometry_.dims = glm::ivec3(384); }
    const VolumeGeometry& geometry() const override { return geometry_; }
    ValueRange range(const glm::ivec3& low, const glm::ivec3& size) const override {
        const glm::dvec3 a(low), b(low + size - 1), middle(192);
        const double nearest = glm::distance(glm::clamp(middle, a, b), middle);
        const double farthest = glm::length(glm::max(glm::abs(a - middle), glm::abs(b - middle)));
        return {static_cast<float>(200 - farthest), static_cast<float>(200 - nearest)};
    }
    void read(const glm::ivec3&, const glm::ivec3&, std::span<float>) const override { FAIL(); }

  private:
    VolumeGeometry geometry_;
};

Scene ball_scene(double iso) {
    Scene scene = two_tone(0, 2);
    scene.iso_values = {iso};
    return scene;
}

TEST(Blocks, AreEmptyIfTransparentOrBuried) {
    const Ball ball;
    Volume outline;
    outline.geometry = ball.geometry();
    outline.min_value = -200;
    outline.max_value = 200;
    const auto blocks = [&](double radius, bool keep_buried) {
        const CollectionPlan plan = plan_collection(outline, ball_scene(200 - radius), {}, keep_buried);
        EXPECT_EQ(plan.buried, !keep_buried);
        return blocks_with_splats(ball, outline, plan).size();
    };
    EXPECT_EQ(blocks(130, true), 27U);
    EXPECT_EQ(blocks(130, false), 26U) << "the middle block is buried";
    EXPECT_EQ(blocks(60, false), 1U) << "the ball lies in the middle block";
}

TEST(Levels, MatchTheWidthOfPixels) {
    VolumeGeometry g;
    g.dims = {100, 100, 100};
    Camera camera;
    camera.direction = {0, 0, -1};
    camera.up = {0, 1, 0};
    camera.fov_y = 90;
    // At distance 256 a pixel of a picture of 512 pixels is 1 mm wide.
    const auto level_at = [&](double distance, double pixels) {
        camera.eye = {50, 50, 99 + distance};
        return level_for(g, 4, camera, {640, 512}, pixels);
    };
    EXPECT_EQ(level_at(257, 1), 0);
    EXPECT_EQ(level_at(511, 1), 0);
    EXPECT_EQ(level_at(513, 1), 1);
    EXPECT_EQ(level_at(513, 0.5), 0);
    EXPECT_EQ(level_at(513, 0), 0);
    EXPECT_EQ(level_at(1025, 1), 2);
    EXPECT_EQ(level_at(1e6, 1), 3);
    EXPECT_EQ(level_at(-50, 1), 0);
    EXPECT_EQ(level_at(-500, 1), 0);
}

TEST(Levels, HaveVoxelNumbersThatFitASplat) {
    VolumeGeometry g;
    g.dims = {1 << 16, 1 << 15, 2};  // 2^32
    EXPECT_EQ(countable_level(g, 4, 0), 0);
    EXPECT_EQ(countable_level(g, 4, 2), 2) << "the requested level is coarse enough";
    g.dims.z = 3;
    EXPECT_EQ(countable_level(g, 4, 0), 1);
    g.dims = {1 << 20, 1 << 14, 1 << 6};  // 2^40, the maximum of a packed volume
    EXPECT_EQ(countable_level(g, 4, 0), 3);
    EXPECT_EQ(countable_level(g, 3, 0), 3) << "none of the three levels";
}

TEST(Levels, KeepPositionsAndMeans) {
    const auto volume = sampled(
        {37, 20, 9}, [](const glm::dvec3& p) { return 2 * p.x - 3 * p.y + 5 * p.z; },
        glm::dmat3(glm::dvec3(1, 0.1, 0), glm::dvec3(0, 2, 0), glm::dvec3(0.2, 0, 3)));
    const Volume half = halved(*volume);
    EXPECT_EQ(half.geometry.dims, glm::ivec3(19, 10, 5));
    for (const glm::ivec3 p : {glm::ivec3(0), glm::ivec3(17, 9, 3), glm::ivec3(4, 2, 1)}) {
        // The mean of a linear field is its value at the centre.
        const glm::dvec3 at = volume->geometry.to_index(half.geometry.to_world(p));
        EXPECT_NEAR(half.at(p.x, p.y, p.z), 2 * at.x - 3 * at.y + 5 * at.z, 1e-5);
    }
    // At an odd end the mean is over the existing samples.
    EXPECT_NEAR(half.at(18, 0, 0), 2 * 36 - 3 * 0.5 + 5 * 0.5, 1e-5);
    EXPECT_EQ(half.min_value, volume->min_value);
    EXPECT_EQ(level_geometry(volume->geometry, 1).origin, half.geometry.origin);
    EXPECT_EQ(level_count(*volume), 1);
    EXPECT_EQ(level_count(*gyroid({200, 60, 10})), 3);
}

TEST(Levels, ShowTheSameSurfaceCoarser) {
    Shot shot;
    const glm::dvec3 centre(62.3, 64.1, 65);
    shot.volume = sampled(glm::ivec3(128), [&](const glm::dvec3& p) { return 40 - glm::length(p - centre); });
    shot.scene = ball_scene(0);
    shot.camera = look(*shot.volume, {64, -900, 80}, {64, 64, 64}, 9);
    const Image fine = render(shot).color;
    shot.settings.detail = 2;
    const RenderResult coarse = render(shot);
    EXPECT_EQ(coarse.stats.level, 1);
    EXPECT_LT(coarse.stats.splats_collected * 3, 40U * 40U * 13U * 12U);
    EXPECT_GE(compare_images(coarse.color, fine).psnr, 32);
    // In a picture of the full volume again, no coarse level is reused.
    shot.settings.detail = 0;
    EXPECT_EQ(compare_images(render(shot).color, fine).rmse, 0);
}

}  // namespace
}  // namespace edgesplat::test
