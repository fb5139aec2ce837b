// Passes 3 and 4 against the reference, and against the properties of a stable sort.
#include <algorithm>
#include <cmath>
#include <numeric>

#include "engine/reference/footprints.h"
#include "tests/passes/pass_fixture.h"

namespace edgesplat::test {
namespace {

constexpr glm::ivec2 kSortSize{96, 80};

class SelectFootprints : public NeedsLayers<> {};

struct SortedFrame {
    std::vector<std::uint32_t> sheets, order;
    std::vector<shader::SheetGroup> groups;
};

SortedFrame sorted_frame(DeviceUnderTest& state, const PassScene& s) {
    state.draw(s.scene, s.camera, layered(s.settings), kSortSize, shader::PAYLOAD_COLOR);
    const auto n = state.lists().splat_count;
    const std::size_t count = state.targets().drawn.mapped<std::uint32_t>(1)[0];
    const auto groups = state.targets().groups.mapped<shader::SheetGroup>(state.plan().params.group_count);
    return {download<std::uint32_t>(state, state.targets().sheet_of, n),
            download<std::uint32_t>(state, state.targets().order, count),
            {groups.begin(), groups.end()}};
}

TEST_F(SelectFootprints, KeepsAndPlacesTheReferencesSplats) {
    for (const PassScene& s : pass_scenes()) {
        SCOPED_TRACE(s.name);
        DeviceUnderTest& state = prepared(s);
        const auto records = device_records(state);
        const auto got = sorted_frame(state, s);
        const Oracle oracle(s, records, kSortSize);
        const auto& want = oracle.selected;
        const double thickness = s.settings.sheet_spacing * oracle.view.mm_per_voxel_along;
        std::size_t kept = 0, moved = 0;
        for (std::size_t i = 0; i < records.size(); ++i) {
            if (got.sheets[i] == shader::SHEET_NONE) {
                // A culled splat must be invisible in all pixels of the reference's box.
                if (!want[i].kept) continue;
                const auto& box = want[i].box;
                double seen = 0;
                for (int y = box.y0; y < box.y1; ++y) {
                    for (int x = box.x0; x < box.x1; ++x)
                        seen = std::max(seen, oracle.drawer.tau(static_cast<std::uint32_t>(i), x, y));
                }
                EXPECT_LE(seen, 1e-6) << "splat " << i;
                continue;
            }
            ++kept;
            const int sheet = static_cast<int>(got.sheets[i]) + state.plan().params.sheet_base;
            const double exact = std::max(want[i].z / thickness, 0.0);
            // Within rounding of a sheet boundary either side is right.
            EXPECT_LE(static_cast<double>(sheet), exact + 1e-4);
            EXPECT_GT(static_cast<double>(sheet) + 1, exact - 1e-4);
            moved += sheet != static_cast<int>(std::floor(exact)) ? 1U : 0U;
        }
        EXPECT_GT(kept, 100U);
        EXPECT_LE(moved, kept / 100);
    }
}

TEST_F(SelectFootprints, GroupRectanglesContainEveryTouchedPixel) {
    const PassScene s = pass_scenes()[0];
    DeviceUnderTest& state = prepared(s);
    const auto got = sorted_frame(state, s);
    const auto pixels = state.targets().output.mapped<glm::vec4>(static_cast<std::size_t>(kSortSize.x * kSortSize.y));
    glm::ivec4 all(kSortSize, 0, 0);
    for (const auto& group : got.groups) {
        if (group.count == 0) continue;
        EXPECT_LT(group.rect.x, group.rect.z);
        EXPECT_GE(group.rect.x, 0);
        EXPECT_LE(group.rect.z, kSortSize.x);
        all = {glm::min(glm::ivec2(all), glm::ivec2(group.rect)),
               glm::max(glm::ivec2(all.z, all.w), glm::ivec2(group.rect.z, group.rect.w))};
    }
    EXPECT_LT((all.z - all.x) * (all.w - all.y), kSortSize.x * kSortSize.y) << "the rectangle covers the whole picture";
    std::size_t touched = 0;
    for (int y = 0; y < kSortSize.y; ++y) {
        for (int x = 0; x < kSortSize.x; ++x) {
            if (pixels[static_cast<std::size_t>(y * kSortSize.x + x)].a <= 0) continue;
            ++touched;
            ASSERT_TRUE(x >= all.x && x < all.z && y >= all.y && y < all.w) << x << "," << y;
        }
    }
    EXPECT_GT(touched, 500U);
}

TEST(SortSheets, IsAStablePermutationOfTheDrawnSplats) {
    if (!layers_obstacle().empty()) GTEST_SKIP() << layers_obstacle();
    for (const PassScene& s : pass_scenes()) {
        SCOPED_TRACE(s.name);
        DeviceUnderTest& state = prepared(s);
        const auto got = sorted_frame(state, s);
        std::vector<std::uint32_t> want;
        for (std::uint32_t i = 0; i < got.sheets.size(); ++i) {
            if (got.sheets[i] != shader::SHEET_NONE) want.push_back(i);
        }
        std::stable_sort(want.begin(), want.end(), [&](auto a, auto b) { return got.sheets[a] < got.sheets[b]; });
        EXPECT_EQ(got.order, want);

        std::uint32_t first = 0;
        for (const auto& group : got.groups) {
            EXPECT_EQ(group.first, first);
            first += group.count;
        }
        EXPECT_EQ(first, got.order.size());
    }
}

TEST(SortSheets, SortsThousandsOfThinSheets) {
    if (!layers_obstacle().empty()) GTEST_SKIP() << layers_obstacle();
    PassScene s = pass_scenes()[0];
    DeviceUnderTest& state = prepared(s);
    s.settings.sheet_spacing = 0.05;  // the minimum
    const auto got = sorted_frame(state, s);
    EXPECT_GT(state.plan().params.sheet_count, 400U);
    for (std::size_t i = 1; i < got.order.size(); ++i)
        EXPECT_LE(got.sheets[got.order[i - 1]], got.sheets[got.order[i]]);
}

}  // namespace
}  // namespace edgesplat::test
