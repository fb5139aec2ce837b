// Sheets summed tile by tile: the lists of the tiles, and the picture against layers.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numeric>

#include "engine/frame/tiles/tile_passes.h"
#include "engine/frame/tiles_cpu/lists.h"
#include "engine/passes/4_sort_tiles.h"
#include "tests/passes/pass_fixture.h"

namespace edgesplat::test {
namespace {

constexpr int kTileSide = static_cast<int>(shader::TILE);
const glm::ivec2 kTilesSize(70, 45);  // neither side is a multiple of a tile's

std::vector<glm::vec4> picture(DeviceUnderTest& state, const PassScene& s, const Settings& settings,
                               std::uint32_t payload) {
    state.draw(s.scene, s.camera, settings, kTilesSize, payload);
    const auto pixels = state.targets().output.mapped<glm::vec4>(static_cast<std::size_t>(kTilesSize.x * kTilesSize.y));
    return {pixels.begin(), pixels.end()};
}

/// Draws the last picture again, in chunks of at most `limit` pairs. Returns the number of chunks.
std::size_t in_chunks(DeviceUnderTest& state, std::uint64_t limit) {
    FramePlan plan = state.plan();
    sort_frame(state.commands(), plan, state.targets());
    const std::uint32_t sheets = plan.params.sheet_count;
    const Chunks chunks =
        plan_chunks(state.targets().sheet_pairs.mapped<std::uint32_t>(sheets),
                    state.targets().sheet_starts.mapped<std::uint32_t>(std::size_t{sheets} + 1), limit);
    state.drawer.targets().provide_chunks(plan, chunks);
    draw_tiles(state.commands(), plan, state.targets(), static_cast<std::uint32_t>(chunks.parts.size()),
               {.profile = &state.device().profile()});
    return chunks.parts.size();
}

/// The lists of the last chunk; entries are splat numbers and sheets.
struct Lists {
    std::vector<glm::uvec2> ranges, entries, rects;
    std::vector<std::uint32_t> sheet_of;
};

Lists lists_of(DeviceUnderTest& state) {
    const auto& p = state.plan().params;
    const auto tiles = static_cast<std::size_t>(p.tiles.x) * static_cast<std::size_t>(p.tiles.y);
    Lists lists;
    lists.ranges = download<glm::uvec2>(state, state.targets().tile_ranges, tiles);
    lists.entries = download<glm::uvec2>(state, state.targets().tile_entries, lists.ranges.back().y);
    // Each list begins at a multiple of MARKED_AT_ONCE.
    std::vector<glm::uvec2> packed;
    for (glm::uvec2& range : lists.ranges) {
        EXPECT_EQ(range.x % shader::MARKED_AT_ONCE, 0U);
        const auto first = static_cast<std::uint32_t>(packed.size());
        packed.insert(packed.end(), lists.entries.begin() + range.x, lists.entries.begin() + range.y);
        range = {first, packed.size()};
    }
    lists.entries = std::move(packed);
    const std::uint32_t most = std::ranges::max(lists.entries, {}, &glm::uvec2::x).x + 1;
    const auto order = download<std::uint32_t>(state, state.targets().order, most);
    for (glm::uvec2& entry : lists.entries)
        entry.x = order[entry.x];
    lists.rects = download<glm::uvec2>(state, state.targets().tile_rects, p.splat_count);
    lists.sheet_of = download<std::uint32_t>(state, state.targets().sheet_of, p.splat_count);
    return lists;
}

TEST(SortTiles, ListsEachSplatOncePerTileInSheetOrder) {
    for (const SheetCut sheets : {SheetCut::Whole, SheetCut::Sliced}) {
        for (const PassScene& s : pass_scenes()) {
            SCOPED_TRACE(s.name);
            DeviceUnderTest& state = prepared(s);
            Settings settings = s.settings;
            settings.sheets = sheets;
            settings.sheet_spacing = 1;
            picture(state, s, canonical_settings(settings), shader::PAYLOAD_COLOR);
            in_chunks(state, ~std::uint64_t{0});
            const Lists lists = lists_of(state);
            const auto tiles_x = static_cast<std::size_t>(state.plan().params.tiles.x);
            std::vector<std::vector<glm::uvec2>> want(lists.ranges.size());
            for (std::uint32_t i = 0; i < lists.rects.size(); ++i) {
                const std::uint32_t code = lists.sheet_of[i];
                if (code == shader::SHEET_NONE) continue;
                const bool sliced = sheets == SheetCut::Sliced;
                const std::uint32_t first = sliced ? code & ((1U << shader::SHEET_BITS) - 1) : code;
                const std::uint32_t last = sliced ? first + (code >> shader::SHEET_BITS) : code;
                const glm::uvec2 low(lists.rects[i].x & 0xffffU, lists.rects[i].x >> 16U);
                const glm::uvec2 high(lists.rects[i].y & 0xffffU, lists.rects[i].y >> 16U);
                ASSERT_TRUE(low.x < high.x && low.y < high.y);
                for (std::size_t y = low.y; y < high.y; ++y)
                    for (std::size_t x = low.x; x < high.x; ++x)
                        for (std::uint32_t sheet = first; sheet <= last; ++sheet)
                            want[y * tiles_x + x].emplace_back(i, sheet);
            }
            std::size_t pairs = 0;
            for (std::size_t tile = 0; tile < want.size(); ++tile) {
                std::ranges::stable_sort(want[tile], {}, [](const glm::uvec2& entry) { return entry.y; });
                const glm::uvec2 range = lists.ranges[tile];
                ASSERT_EQ(range.y - range.x, want[tile].size()) << "tile " << tile;
                for (std::size_t k = 0; k < want[tile].size(); ++k)
                    ASSERT_EQ(lists.entries[range.x + k], want[tile][k]) << "tile " << tile << ", entry " << k;
                pairs += want[tile].size();
            }
            EXPECT_GT(pairs, 0U);
            const auto counted = state.targets().sheet_pairs.mapped<std::uint32_t>(state.plan().params.sheet_count);
            EXPECT_EQ(std::accumulate(counted.begin(), counted.end(), std::size_t{0}), pairs);
        }
    }
}

TEST(SortTiles, ListsAllPairsOfVeryUnevenSplats) {
    // A plate from right in front of the eye into the distance: some splats cover hundreds of tiles, others one.
    PassScene s;
    s.name = "plate";
    s.volume.geometry.dims = {160, 160, 6};
    for (std::size_t i = 0; i < s.volume.geometry.voxel_count(); ++i)
        s.volume.values.push_back(3.2F - static_cast<float>(i / (160 * 160)));
    finish_volume(s.volume);
    s.scene.iso_values = {0.5};
    s.scene.materials = {{}, {{1, 1, 1}, 2}};
    look_at(s, {2, 2, 4.5}, {80, 80, 2.5}, 130);
    DeviceUnderTest& state = prepared(s);
    state.draw(s.scene, s.camera, canonical_settings(s.settings), {1024, 1024}, shader::PAYLOAD_COLOR);
    ASSERT_EQ(in_chunks(state, ~std::uint64_t{0}), 1U);
    const auto& p = state.plan().params;
    const auto pairs = state.targets().sheet_pairs.mapped<std::uint32_t>(p.sheet_count);
    const auto all = std::accumulate(pairs.begin(), pairs.end(), std::uint64_t{0});
    // One column has more pairs than one invocation may process in a dispatch.
    const auto starts = state.targets().sheet_starts.mapped<std::uint32_t>(std::size_t{p.sheet_count} + 1);
    EXPECT_GT(most_column_pairs({0, starts.back()}, p.tile_blocks, pairs, starts), 2 * shader::PAIR_STEPS);
    const Lists lists = lists_of(state);
    EXPECT_EQ(lists.ranges.back().y, all);
    std::vector<std::uint64_t> listed(p.splat_count), want(p.splat_count);
    for (const glm::uvec2& entry : lists.entries) {
        ASSERT_LT(entry.x, p.splat_count);
        ASSERT_EQ(entry.y, lists.sheet_of[entry.x]);
        ++listed[entry.x];
    }
    for (std::uint32_t i = 0; i < p.splat_count; ++i) {
        if (lists.sheet_of[i] == shader::SHEET_NONE) continue;
        const glm::uvec2 low(lists.rects[i].x & 0xffffU, lists.rects[i].x >> 16U);
        const glm::uvec2 high(lists.rects[i].y & 0xffffU, lists.rects[i].y >> 16U);
        want[i] = std::uint64_t{high.x - low.x} * (high.y - low.y);
    }
    EXPECT_EQ(listed, want);
}

TEST(DrawTiles, MatchesThePicturesOfLayers) {
    if (!layers_obstacle().empty()) GTEST_SKIP() << layers_obstacle();
    for (const std::uint32_t payload :
         {shader::PAYLOAD_COLOR, shader::PAYLOAD_TAU, shader::PAYLOAD_DEPTH_DISTANCE, shader::PAYLOAD_NORMAL}) {
        for (PassScene s : pass_scenes()) {
            SCOPED_TRACE(s.name);
            // Pixels become saturated group by group in layers, but sheet by sheet in tiles; layers draw every pixel.
            s.settings.saturation = 1;
            s.settings.pixels = PixelChoice::Every;
            DeviceUnderTest& state = prepared(s);
            const auto layers = picture(state, s, layered(s.settings), payload);
            const auto tiles = picture(state, s, s.settings, payload);
            ASSERT_TRUE(state.plan().variant.tiles);
            float peak = 0, worst = 0;
            // Means are weighted by opacity: at the rim of a footprint one of the two may be empty.
            const bool means = payload == shader::PAYLOAD_DEPTH_DISTANCE || payload == shader::PAYLOAD_NORMAL;
            for (std::size_t i = 0; i < tiles.size(); ++i) {
                for (int c = 0; c < 4; ++c) {
                    const float a = means && c < 3 ? layers[i].a : 1, b = means && c < 3 ? tiles[i].a : 1;
                    ASSERT_TRUE(std::isfinite(tiles[i][c]));
                    peak = std::max(peak, std::abs(a * layers[i][c]));
                    worst = std::max(worst, std::abs(b * tiles[i][c] - a * layers[i][c]));
                }
            }
            EXPECT_GT(peak, 0);
            std::printf("payload %u %-24s worst of peak %.1e\n", payload, s.name.c_str(),
                        static_cast<double>(worst / peak));
            // Where a ray just misses a curved face, the root of a difference near 0 has half of float's digits: an
            // error of 3e-4 of one splat.
            EXPECT_LE(worst, 1e-4F * peak);
        }
    }
}

TEST(DrawTiles, CountsSaturatedPixels) {
    PassScene s = pass_scenes()[0];
    for (Material& material : s.scene.materials)
        material.extinction *= 40;
    DeviceUnderTest& state = prepared(s);
    const auto whole = picture(
        state, s,
        [&] {
            Settings settings = s.settings;
            settings.saturation = 1;
            return settings;
        }(),
        shader::PAYLOAD_COLOR);
    Settings closing = s.settings;
    closing.saturation = 0.9;
    const auto pixels = picture(state, s, closing, shader::PAYLOAD_COLOR);
    const auto closed = download<std::uint32_t>(
        state, state.targets().tile_closed,
        static_cast<std::size_t>(state.plan().params.tiles.x) * static_cast<std::size_t>(state.plan().params.tiles.y));
    std::vector<std::uint32_t> want(closed.size(), 0);
    for (int y = 0; y < kTilesSize.y; ++y) {
        for (int x = 0; x < kTilesSize.x; ++x) {
            const auto i = static_cast<std::size_t>(y * kTilesSize.x + x);
            const bool full = pixels[i].a >= 0.9F;
            want[static_cast<std::size_t>(y / kTileSide * state.plan().params.tiles.x + x / kTileSide)] += full ? 1 : 0;
            if (full) {
                EXPECT_LE(pixels[i].a, whole[i].a + 1e-5F);
            } else {
                EXPECT_NEAR(pixels[i].a, whole[i].a, 1e-5F);
            }
        }
    }
    EXPECT_EQ(closed, want);
    EXPECT_GT(*std::ranges::max_element(closed), 0U);
}

TEST(SortSheets, GivesTheSameOrderInSegments) {
    for (const SheetCut sheets : {SheetCut::Whole, SheetCut::Sliced}) {
        const PassScene s = pass_scenes()[1];
        DeviceUnderTest& state = prepared(s);
        Settings settings = s.settings;
        settings.sheets = sheets;
        picture(state, s, canonical_settings(settings), shader::PAYLOAD_COLOR);
        const std::size_t entries = state.targets().drawn.mapped<std::uint32_t>(4)[0];
        const auto at_once = download<std::uint32_t>(state, state.targets().order, entries);
        const std::uint32_t per_block =
            (state.plan().params.splat_count + shader::SORT_BLOCKS - 1) / shader::SORT_BLOCKS;
        ASSERT_GT(per_block, 1U);
        EXPECT_GE(state.plan().sort_segments * state.plan().params.sort_segment, per_block);
        FramePlan plan = state.plan();
        plan.sort_segments = per_block;
        state.targets().frame.mapped<shader::FrameBlock>(1)[0].frame.sort_segment = 1;
        sort_frame(state.commands(), plan, state.targets());
        EXPECT_EQ(state.targets().drawn.mapped<std::uint32_t>(4)[0], entries);
        EXPECT_EQ(download<std::uint32_t>(state, state.targets().order, entries), at_once);
    }
}

TEST(SortSheets, SegmentsCoverEveryList) {
    const PassScene s = pass_scenes()[0];
    for (const SheetCut sheets : {SheetCut::Whole, SheetCut::Sliced}) {
        Settings settings = s.settings;
        settings.sheets = sheets;
        for (const std::uint64_t splats : {1ULL, 1000ULL, 586473ULL, 20000000ULL, 300000000ULL}) {
            const FramePlan plan =
                plan_frame(s.volume, s.scene, s.camera, canonical_settings(settings), kTilesSize, shader::PAYLOAD_COLOR,
                           {splats, glm::ivec3(0), s.volume.geometry.dims - 1}, 2.5);
            const std::uint64_t covered = std::uint64_t{plan.sort_segments} * plan.params.sort_segment;
            EXPECT_GE(covered * shader::SORT_BLOCKS, splats);
            EXPECT_LE(std::uint64_t{plan.params.sort_segment} * (plan.sheets_per_splat + 1), shader::MOST_ITERATIONS);
        }
    }
}

TEST(DrawTiles, GivesTheSamePictureBeyondThePreparedSplats) {
    // A single sheet with more splats than are prepared; all are visible.
    PassScene s;
    s.volume.geometry.dims = {400, 400, 5};
    for (std::size_t i = 0; i < s.volume.geometry.voxel_count(); ++i)
        s.volume.values.push_back(i / (400 * 400) == 2 ? 1.0F : 0.0F);
    finish_volume(s.volume);
    s.scene.iso_values = {0.5};
    s.scene.materials = {{}, {{1, 0.5, 0.2}, 0.4}};
    look_at(s, {199.5, 180, 400}, {199.5, 199.5, 2}, 60);
    s.settings.sheet_spacing = 8;
    DeviceUnderTest& state = prepared(s);
    const auto want = picture(state, s, s.settings, shader::PAYLOAD_COLOR);
    in_chunks(state, ~std::uint64_t{0});
    const auto parts = state.targets().chunks.mapped<glm::uvec2>(1);
    ASSERT_GT(parts[0].y - parts[0].x, state.plan().params.prepared_mask + 1);
    // The same splats in thin sheets, few enough per sheet.
    Settings thin = s.settings;
    thin.sheet_spacing = 0.02;
    const auto few = picture(state, s, thin, shader::PAYLOAD_TAU);
    const auto many = picture(state, s, s.settings, shader::PAYLOAD_TAU);
    float peak = 0, worst = 0;
    for (std::size_t i = 0; i < few.size(); ++i) {
        peak = std::max(peak, few[i].a);
        worst = std::max(worst, std::abs(few[i].a - many[i].a));
    }
    EXPECT_GT(peak, 0.1F);
    EXPECT_LE(worst, 1e-5F * peak);
    EXPECT_GT(want[want.size() / 2].a, 0.1F);
}

TEST(PlanChunks, GivesWholeSheetsWithinTheLimit) {
    const std::vector<std::uint32_t> pairs{5, 0, 4, 3, 20, 1, 0, 2}, starts{0, 2, 2, 4, 6, 9, 10, 10, 12};
    const Chunks chunks = plan_chunks(pairs, starts, 10);
    const std::vector<glm::uvec2> want{{0, 4}, {4, 6}, {6, 9}, {9, 12}};
    EXPECT_EQ(chunks.parts, want);
    EXPECT_EQ(chunks.most_pairs, 20U);
    EXPECT_TRUE(plan_chunks(std::vector<std::uint32_t>{0, 0}, std::vector<std::uint32_t>{0, 0, 0}, 10).parts.empty());
    EXPECT_EQ(plan_chunks(pairs, starts, 1000).parts, (std::vector<glm::uvec2>{{0, 12}}));
    EXPECT_EQ(plan_chunks(pairs, starts, 1000, 4).parts, (std::vector<glm::uvec2>{{0, 4}, {4, 6}, {6, 10}, {10, 12}}));
}

TEST(PlanChunks, GivesTheSameChunksOnDeviceAndHost) {
    PassScene s = pass_scenes()[1];
    s.settings.sheet_spacing = 0.05;
    DeviceUnderTest& state = prepared(s);
    picture(state, s, s.settings, shader::PAYLOAD_COLOR);
    auto& p = state.targets().frame.mapped<shader::FrameBlock>(1)[0].frame;
    ASSERT_GT(p.sheet_count, 512U) << "more than a workgroup loads together";
    const std::uint32_t places = p.prepared_mask + 1;
    for (const std::uint32_t limit : {1U, 100U, 3000U, 1U << 20U}) {
        for (const std::uint32_t entries : {places, 64U}) {
            for (const std::uint32_t slots : {1U, 3U, p.sheet_count}) {
                p.chunk_pairs = limit;
                p.chunk_slots = slots;
                p.prepared_mask = entries - 1;
                state.commands().run([&] {
                    sort_splats(state.commands(), state.plan(), state.targets(), false);
                    state.commands().pass(passes::plan_chunks());
                });
                const auto pairs = sheet_pairs(state.plan(), state.targets());
                const auto starts = sheet_starts(state.plan(), state.targets());
                const Chunks chunks = plan_chunks(pairs, starts, limit, entries);
                std::vector<glm::uvec2> want(slots);
                for (std::size_t i = 0; i < std::min<std::size_t>(slots, chunks.parts.size()); ++i) {
                    std::uint64_t sum = 0;
                    for (std::size_t sheet = 0; sheet < pairs.size(); ++sheet)
                        if (starts[sheet] >= chunks.parts[i].x && starts[sheet] < chunks.parts[i].y)
                            sum += pairs[sheet];
                    if (sum <= limit && chunks.parts[i].y - chunks.parts[i].x <= entries) want[i] = chunks.parts[i];
                }
                EXPECT_EQ(download<glm::uvec2>(state, state.targets().chunks, slots), want)
                    << limit << " pairs, " << entries << " splats, " << slots << " chunks";
                const auto kept = std::ranges::count_if(want, [](const glm::uvec2& part) { return part.y > 0; });
                EXPECT_EQ(fit(chunks, p, slots), static_cast<std::size_t>(kept) == chunks.parts.size());
            }
        }
    }
    p.prepared_mask = places - 1;
}

TEST(DrawTiles, GivesTheSamePictureInManyChunks) {
    const PassScene s = pass_scenes()[1];
    DeviceUnderTest& state = prepared(s);
    const auto once = picture(state, s, s.settings, shader::PAYLOAD_COLOR);
    EXPECT_GT(in_chunks(state, 1), 3U);
    const auto pixels = state.targets().output.mapped<glm::vec4>(once.size());
    EXPECT_TRUE(std::ranges::equal(pixels, once));
}

TEST(RefinePixels, GivesTheSamePictureInManyChunks) {
    if (!device_under_test().device().profile().refines) GTEST_SKIP() << "this device draws every pixel";
    // Translucent and opaque: behind chunks whose lists are kept or discarded, tiles become saturated or not.
    for (const double extinction : {0.05, 3.0}) {
        PassScene s = pass_scenes()[2];
        s.scene.materials[1].extinction = extinction;
        DeviceUnderTest& state = prepared(s);
        const glm::ivec2 size(150, 121);
        state.draw(s.scene, s.camera, s.settings, size, shader::PAYLOAD_COLOR);
        ASSERT_TRUE(state.plan().refined);
        const auto pixels = state.targets().output.mapped<glm::vec4>(static_cast<std::size_t>(size.x * size.y));
        const std::vector<glm::vec4> once(pixels.begin(), pixels.end());
        for (const std::uint64_t limit : {1U, 500U, 20000U}) {
            EXPECT_GT(in_chunks(state, limit), limit > 500 ? 0U : 3U);
            float most = 0;
            for (std::size_t i = 0; i < once.size(); ++i)
                for (int c = 0; c < 4; ++c)
                    most = std::max(most, std::abs(pixels[i][c] - once[i][c]));
            EXPECT_LE(most, 2e-6F) << "chunks of " << limit << " pairs, extinction " << extinction;
        }
    }
}

/// The buffers with data per entry may differ in size: earlier pictures may have enlarged only some of them.
TEST(KeptLists, FitIntoEveryBuffer) {
    const gpu::Device& device = device_under_test().device();
    const auto buffer = [&](std::uint64_t bytes) {
        return gpu::Buffer(device, bytes, gpu::Buffer::Place::Host, "test");
    };
    constexpr std::uint64_t kRoom = 320;
    TargetResources targets;
    targets.tile_entries = buffer(1000 * sizeof(glm::uvec2));
    targets.tile_marks = buffer(1000 * sizeof(std::uint32_t));
    targets.traced_entries = buffer(kRoom / shader::MARKED_AT_ONCE * sizeof(std::uint32_t));
    targets.frame = buffer(sizeof(shader::FrameBlock));
    targets.tile_ranges = buffer(sizeof(glm::uvec2));
    targets.tile_todo = buffer(sizeof(std::uint32_t));
    targets.tile_closed_on_host = buffer(sizeof(std::uint32_t));
    FramePlan plan;
    plan.params.tiles = {1, 1};
    const auto first = [&] { return targets.frame.mapped<shader::FrameBlock>(1)[0].frame.entries_first; };
    const auto list = [&](std::uint32_t length) { targets.tile_ranges.mapped<glm::uvec2>(1)[0] = {0, length}; };
    targets.tile_todo.mapped<std::uint32_t>(1)[0] = 1;
    targets.tile_closed_on_host.mapped<std::uint32_t>(1)[0] = 0;

    KeptLists kept(plan, targets, 3);
    kept.place(0, 100);
    EXPECT_EQ(first(), 0U);
    list(100);
    kept.keep(0);
    kept.place(1, 90);
    EXPECT_EQ(first(), 128U) << "behind the first, at the beginning of a word of marks";
    list(90);
    kept.keep(1);
    EXPECT_TRUE(kept.take(0) && kept.take(1));
    EXPECT_EQ(first(), 128U);
    kept.place(2, 150);
    EXPECT_EQ(first(), 160U) << "the smallest buffer has room for 320 entries";
    EXPECT_TRUE(kept.take(0));
    EXPECT_FALSE(kept.take(1)) << "its place was used again";
}

}  // namespace
}  // namespace edgesplat::test
